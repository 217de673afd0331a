#include "volume/moving_round.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include <Eigen/Geometry>

#include "volume/contact_pairs.h"

namespace vmesh {
namespace {

// Of the share that may be taken: aims for a little less, so that rounds of moving end; safe 0.035 to 0.07.
constexpr double kSpareLength = 0.05;
// Of the wanted distance: axes farther apart than that determine the direction; safe 0.17 to 0.35.
constexpr double kFarApart = 0.25;
// Sine of the angle between axes from which on they cross; idle 0.14 to 0.28.
constexpr double kCrossing = 0.2;
// Radii: axes closer than that determine no direction; idle 0.0007 to 0.0014.
constexpr double kNearlyTouching = 1e-3;
// Cosine between the move and its axis above which a vessel is not moved; safe 0.35 to 0.7.
constexpr double kSideways = 0.5;
constexpr double kSameDirection = 0.7;  // cosine; safe 0.49 to 0.98
constexpr double kSamePart =
    0.3;  // of a shift: where it moves a leaf by less, another shift is added; idle 0.21 to 0.42
constexpr double kFarthest = 2.2;  // sums of radii: the most that a vessel is moved; idle 1.5 to 3.1
constexpr double kAlong = 12;      // sums of radii along the graph over which one shift acts; idle 8.4 to 17

// A leaf of one vessel that is too close to another.
struct CloseLeaf {
  Index cone = kNone, other = kNone;
  MovedStretch stretch;
  Vec3 from_other = Vec3::Zero();  // from the other's axis to this one, mm
  double wanted = 0;               // distance of the axes
  double share = 1;                // of its radius that would remain
  ContactSide side, other_side;    // on the original
};

Vec3 tangent_of(const ConeAxes& cones, Index cone) {
  const Vec3 axis = cones.axis_point(cone, 1) - cones.axis_point(cone, 0);
  const double length = axis.norm();
  return length > 0 ? Vec3(axis / length) : Vec3(Vec3::Zero());
}

Vec3 some_perpendicular(const Vec3& direction) {
  if (direction.isZero()) return Vec3::UnitX();
  Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  return direction.cross(Vec3::Unit(least)).normalized();
}

class MovingRound {
 public:
  MovingRound(const MovingTask& task, Moving& moving)
      : task_(task), moving_(moving), cones_(task.narrowed.centerline) {}

  int run() {
    for (const auto& [region, leaves] : close_regions()) answer(leaves);
    return static_cast<int>(changed_.size());
  }

 private:
  using Region = std::vector<CloseLeaf>;

  // The leaves that would lose too much, by region.
  std::map<Index, Region> close_regions() const {
    std::map<Index, Region> regions;
    for (const ContactPair& pair : task_.pairs) {
      for (const auto& [cone, other] : {std::pair{pair.i, pair.j}, std::pair{pair.j, pair.i}}) {
        for (CloseLeaf& leaf : close_leaves(cone, other, pair.gap)) regions[pair.region].push_back(std::move(leaf));
      }
    }
    return regions;
  }

  Region close_leaves(Index cone, Index other, double gap) const {
    Region leaves;
    const AxisStretch across = cones_.stretch(other);
    const Index count = cone < task_.narrowed.pieces.size() ? leaf_count_of(task_.narrowed.centerline, cone) : 1;
    for (Index n = 0; n < count; ++n) {
      const double first = static_cast<double>(n) / count, last = static_cast<double>(n + 1) / count;
      const AxisStretch part = cones_.stretch(cone, first, last);
      if (are_apart(part, across, gap, 0)) continue;
      const ClosestApproach closest = closest_approach(part, across, gap);
      if (closest.excess >= 0) continue;
      CloseLeaf leaf;
      leaf.cone = cone;
      leaf.other = other;
      leaf.side = original_side(cone, std::lerp(first, last, closest.s));
      leaf.other_side = original_side(other, closest.t);
      leaf.stretch = original_stretch(cone, first, last);
      leaf.from_other = part.point(closest.s) - across.point(closest.t);
      const double r = leaf.side.radius, q = leaf.other_side.radius;
      const double free = r + q + gap * std::min(r, q);
      leaf.wanted = (1 - (1 - kSpareLength) * task_.most_narrowed) * free;
      leaf.share = share_left(part.radius(closest.s), across.radius(closest.t), closest.distance, gap, r);
      if (leaf.share < 1 - task_.most_narrowed) leaves.push_back(leaf);
    }
    return leaves;
  }

  // Share of the original radius that remains when both radii give up the same share of their present values.
  static double share_left(double radius, double other, double distance, double gap, double original_radius) {
    return radius * distance / (radius + other + gap * std::min(radius, other)) / original_radius;
  }

  ContactSide original_side(Index cone, double t) const {
    if (cones_.is_sphere(cone)) {
      const auto segment = static_cast<Index>(task_.original.segments().size() + cone - task_.narrowed.pieces.size());
      return {segment, 0, kNone, task_.original.node(cones_.isolated_node(cone)).radius};
    }
    const SegmentPiece& piece = task_.narrowed.pieces[cone];
    const double original_t = piece.original_t(t);
    return {piece.segment, original_t, kNone, task_.original.radius_at(piece.segment, original_t)};
  }

  MovedStretch original_stretch(Index cone, double first, double last) const {
    if (cones_.is_sphere(cone)) return {kNone, 0, 0, cones_.isolated_node(cone)};
    const SegmentPiece& piece = task_.narrowed.pieces[cone];
    return {piece.segment, piece.original_t(first), piece.original_t(last), kNone};
  }

  // The leaf, on the vessel to be moved, at the closest approach of a region.
  const CloseLeaf& anchor_of(const Region& region) const {
    const auto is_less = [](const CloseLeaf& a, const CloseLeaf& b) { return a.share < b.share; };
    const CloseLeaf& worst = *std::min_element(region.begin(), region.end(), is_less);
    const double own = worst.side.radius, other = worst.other_side.radius;
    const Index thinner = own != other ? (own < other ? worst.cone : worst.other) : std::max(worst.cone, worst.other);
    const Index moving = (thinner == worst.cone) != task_.choice.thicker ? worst.cone : worst.other;
    const CloseLeaf* anchor = nullptr;
    for (const CloseLeaf& leaf : region) {
      if (leaf.cone == moving && (!anchor || is_less(leaf, *anchor))) anchor = &leaf;
    }
    return anchor ? *anchor : worst;
  }

  void answer(const Region& region) {
    const CloseLeaf& anchor = anchor_of(region);
    const MovedStretch across = original_stretch(anchor.other, 0, 1);
    for (const Index shift : changed_) {
      if (moving_.part_at(shift, anchor.stretch) > 0 || moving_.part_at(shift, across) > 0) return;
    }
    Moving::Shift shift;
    shift.moved = anchor.side;
    shift.other = anchor.other_side;
    shift.direction = direction_away(anchor);
    const Index known = shift_there(anchor.stretch, shift.direction);
    if (known != kNone) {
      shift.direction = moving_.shifts()[known].direction;
      shift.distance = moving_.part_at(known, anchor.stretch) * moving_.shifts()[known].distance;
    }
    double further = 0;
    for (const CloseLeaf& leaf : along_the_same_vessel(region, anchor)) {
      if (std::abs(shift.direction.dot(tangent_of(cones_, leaf.cone))) > kSideways) continue;
      further = std::max(further, distance_to_go(leaf, shift.direction));
      shift.stretches.push_back(leaf.stretch);
    }
    shift.distance += further;
    if (shift.stretches.empty() || shift.distance > kFarthest * (anchor.side.radius + anchor.other_side.radius)) return;
    if (known != kNone) {
      if (moving_.extend(known, shift.distance, shift.stretches)) changed_.push_back(known);
    } else if (const Index added = moving_.add(std::move(shift)); added != kNone) {
      changed_.push_back(added);
    }
  }

  static double distance_to_go(const CloseLeaf& leaf, const Vec3& direction) {
    const double gone = leaf.from_other.dot(direction);
    const double missing = leaf.wanted * leaf.wanted - leaf.from_other.squaredNorm();
    return std::sqrt(std::max(0.0, gone * gone + missing)) - gone;
  }

  Index shift_there(const MovedStretch& place, const Vec3& direction) const {
    for (Index shift = 0; shift < moving_.shifts().size(); ++shift) {
      if (moving_.shifts()[shift].direction.dot(direction) > kSameDirection &&
          moving_.part_at(shift, place) > kSamePart)
        return shift;
    }
    return kNone;
  }

  Vec3 direction_away(const CloseLeaf& leaf) const {
    const Vec3 own = tangent_of(cones_, leaf.cone), other = tangent_of(cones_, leaf.other);
    const double apart = leaf.from_other.norm();
    const Vec3 sideways = leaf.from_other - leaf.from_other.dot(own) * own;
    if (apart > kFarApart * leaf.wanted && sideways.norm() > apart / 2) return sideways.normalized();
    Vec3 direction = own.cross(other);
    if (direction.norm() > kCrossing) {
      direction.normalize();
    } else if (sideways.norm() > kNearlyTouching * leaf.side.radius) {
      return sideways.normalized();
    } else {
      direction = some_perpendicular(own.isZero() ? other : own);
    }
    const double gone = leaf.from_other.dot(direction);
    if (std::abs(gone) > kFarApart * leaf.wanted && !task_.choice.opposite)
      return gone > 0 ? direction : Vec3(-direction);
    const double free[2] = {room(leaf, direction), room(leaf, -direction)};
    const bool along = free[0] == free[1] ? gone >= 0 : free[0] > free[1];
    return along != task_.choice.opposite ? direction : Vec3(-direction);
  }

  // How far the walls of other vessels would be from the leaf's axis after it moved, mm.
  double room(const CloseLeaf& leaf, const Vec3& direction) const {
    const double t = task_.narrowed.pieces.size() > leaf.cone ? 0.5 : 0;
    const Vec3 place = cones_.axis_point(leaf.cone, t) + distance_to_go(leaf, direction) * direction;
    return task_.looks.distance_to_others(place, leaf.cone, leaf.wanted);
  }

  // The leaves of a region that are on the anchor's side of it.
  Region along_the_same_vessel(const Region& region, const CloseLeaf& anchor) const {
    const std::map<Index, double> away = walk(anchor, kAlong * (anchor.side.radius + anchor.other_side.radius));
    const auto distance = [&](Index cone) {
      double least = std::numeric_limits<double>::infinity();
      for (const Index n : {cones_.first_node(cone), cones_.last_node(cone)}) {
        const auto found = away.find(n);
        if (found != away.end()) least = std::min(least, found->second);
      }
      return least;
    };
    Region same;
    for (const CloseLeaf& leaf : region) {
      if (leaf.cone == anchor.cone || distance(leaf.cone) < distance(leaf.other)) same.push_back(leaf);
    }
    return same;
  }

  // Nodes within a distance from the anchor along the graph.
  std::map<Index, double> walk(const CloseLeaf& anchor, double farthest) const {
    const Centerline& centerline = task_.narrowed.centerline;
    std::map<Index, double> away;
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto reach = [&](Index node, double distance) {
      if (distance > farthest) return;
      const auto [known, is_new] = away.try_emplace(node, distance);
      if (!is_new && known->second <= distance) return;
      known->second = distance;
      open.emplace(distance, node);
    };
    reach(cones_.first_node(anchor.cone), 0);
    reach(cones_.last_node(anchor.cone), 0);
    while (!open.empty()) {
      const auto [distance, node] = open.top();
      open.pop();
      if (distance > away.at(node)) continue;
      for (const Index s : centerline.incident_segments(node))
        reach(centerline.other_node(s, node), distance + centerline.length(s));
    }
    return away;
  }

  const MovingTask& task_;
  Moving& moving_;
  ConeAxes cones_;
  std::vector<Index> changed_;
};

}  // namespace

int move_apart(const MovingTask& task, Moving& moving) { return MovingRound(task, moving).run(); }

}  // namespace vmesh
