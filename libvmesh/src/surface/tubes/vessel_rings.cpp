#include "surface/tubes/vessel_rings.h"

#include <numbers>

#include "surface/remesh/boundary_point.h"
#include "surface/remesh/edge_lengths.h"

namespace vmesh {
namespace {

// Distance between rings, in heights of an equilateral band at their final radius; safe only at this value, below
// vertices +13 %, above vertices -11 %, skewer.
constexpr double kPitch = 1.055;
// Radii to either side over which the direction of the vessel is averaged; safe 0.42 to 0.84.
constexpr double kSmoothing = 0.6;
constexpr int kSteps = 8;  // of the search for the boundary along a ray; safe 6 to 11
// Radii, up to 24 around and with an error limit; derived: a tenth of kOffBoundary, and at 24 around a ninth of
// what edges cut off. Beyond that it shrinks as that does, down to what single precision tells.
constexpr double kOnBoundary = 1e-3, kFullTolerance = 24;
// Radii between which the boundary must lie; kNearest: idle 0.35 to 0.7; kFarthest: safe 1.4 to 2.8.
constexpr double kNearest = 0.5, kFarthest = 2;
constexpr double kFacing = 0.5;    // cosine between ray and boundary normal; safe 0.35 to 0.7
constexpr double kOwnReach = 1.5;  // radii along the branch from which the boundary may come; safe 1 to 2.1
// No other vessel may come closer than `space` to the points at the distance `far` from the axis (both in radii) in
// kDirections directions.
struct Clearance {
  double far, space;
};
constexpr Clearance kClearances[] = {{0, 0}, {0.5, 0}, {1, 0}, {1.35, 0.15}};
constexpr double kNeighbourhood = 1.5;  // radii around the axis within which that may fail; safe 1 to 2.1
constexpr int kDirections = 24;         // safe 17 to 34
constexpr int kPlacesThrough = 6;       // idle 4 to 8
// Least cosine between the vessel's direction and the normal of its cross-section; safe 0.21 to 0.42.
constexpr double kThrough = 0.3;
constexpr double kStraight = 1e-3;      // derived: sine below which directions count as equal, far above their rounding
constexpr double kLongestSkip = 2.5;    // radii along the branch; safe 1.8 to 3.5
constexpr double kStraightSkip = 0.95;  // cosine; safe 0.66 to 1.3
constexpr double kNoGap = 1.5;          // even steps between rings from which on one is missing between them
constexpr double kMinSpacing = 0.2;     // least distance between two rings, in pitches; safe 0.14 to 0.28

// Height of the band of triangles between two rings, in ring radii, when all its edges are as long as the ring's.
double equilateral_height(int around) {
  const double edge = 2 * std::sin(std::numbers::pi / around);
  const double shift = 2 * std::sin(std::numbers::pi / (2 * around));  // of a vertex turned half a step
  return std::sqrt(edge * edge - shift * shift);
}

double on_boundary(const RingOptions& options) {
  if (options.limit.is_set()) return kOnBoundary;
  const double finer = std::max(1.0, options.around / kFullTolerance);
  return std::max(kRoughTolerance, kOnBoundary / (finer * finer));
}

CrossSection section_at(const BranchAxis& axis, double radii) {
  if (axis.periodic()) radii -= axis.length_in_radii() * std::floor(radii / axis.length_in_radii());
  const double place = axis.place_at_radii(radii);
  const auto point = axis.at(place);
  return {place, point.position, axis.direction(place, kSmoothing * point.radius), point.radius};
}

/// `v` after the shortest turn that takes direction `from` to `to`: Eigen's Quaternion::FromTwoVectors(), but for
/// opposite ones a half turn about any axis across, which needs no singular values (50 kB of WebAssembly).
Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < Eigen::NumTraits<double>::dummy_precision() - 1) {
    const Vec3 axis = a.unitOrthogonal();
    return 2 * axis.dot(v) * axis - v;
  }
  const double twice_w = std::sqrt(2 * (1 + cosine));
  Eigen::Quaterniond turn;
  turn.vec() = a.cross(b) * (1 / twice_w);
  turn.w() = 0.5 * twice_w;
  return turn * v;
}

bool apart(const Ring& ring, const Ring& next, double gap) {
  for (const auto& p : next.points) {
    if ((p.position - ring.center).dot(ring.normal) < gap * ring.radius) return false;
  }
  for (const auto& p : ring.points) {
    if ((next.center - p.position).dot(next.normal) < gap * next.radius) return false;
  }
  return true;
}

// Whether the rings are close together and the vessel hardly bends between them.
bool is_straight_between(const Ring& ring, const Ring& next) {
  const double along = next.place - ring.place;
  const Vec3 chord = next.center - ring.center;
  return along < kLongestSkip * std::max(ring.radius, next.radius) && chord.dot(ring.normal) > kStraightSkip * along &&
         chord.dot(next.normal) > kStraightSkip * along;
}

}  // namespace

CrossSection section_beside(const BranchAxis& axis, const Ring& ring, bool after) {
  return section_at(axis, after ? ring.radii + ring.step / 2 : ring.radii - ring.step / 2);
}

double ring_pitch(int around) { return kPitch * balanced_ring_radius(around) * equilateral_height(around); }

RingLayer::RingLayer(const VesselField& field, const std::vector<BranchAxis>& axes,
                     const std::vector<BranchPlace>& places, const RingOptions& options)
    : field_(field), axes_(axes), places_(places), options_(options) {}

Rings RingLayer::lay(Index branch) const {
  std::vector<Vec3> sides;
  Rings even = lay_evenly(branch, sides);
  return options_.elongation > 1 ? spread(branch, even, sides) : std::move(even);
}

// `sides`: of every ring, from where its angles count.
Rings RingLayer::lay_evenly(Index branch, std::vector<Vec3>& sides) const {
  const BranchAxis& axis = axes_[branch];
  const double pitch = options_.pitch();
  const double total = axis.length_in_radii();
  const auto bands = static_cast<std::size_t>(std::max(1.0, std::round(total / pitch)));
  const double step = total / static_cast<double>(bands);
  const std::size_t count = axis.periodic() ? bands : bands + 1;
  Rings laid;
  std::vector<Ring>& rings = laid.rings;
  rings.reserve(count);
  laid.points.reserve(count * static_cast<std::size_t>(options_.around));
  Vec3 side = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const double radii = step * static_cast<double>(k);
    const CrossSection here = section_at(axis, radii);
    side = k == 0 ? reference(branch, here.normal) : turned(side, rings.back().normal, here.normal);
    side = (side - side.dot(here.normal) * here.normal).normalized();
    rings.push_back(lay_one(branch, here, side, static_cast<double>(k % 2) / 2, laid.points));
    rings.back().radii = radii;
    rings.back().step = step;
    sides.push_back(side);
  }
  std::vector<char> collides(rings.size(), 0);
  for (std::size_t k = 0; k < bands && rings.size() > 1; ++k) {
    const std::size_t next = (k + 1) % rings.size();
    if (!rings[k].free || !rings[next].free || apart(rings[k], rings[next], kMinSpacing * pitch)) continue;
    collides[k] = collides[next] = 1;
  }
  for (std::size_t k = 0; k < rings.size(); ++k) rings[k].free = rings[k].free && !collides[k];
  leave_out_steps(rings, sides, kMinSpacing * pitch);
  if (!axis.periodic() && !axis.starts_at_tip()) rings.front().free = false;
  if (!axis.periodic() && !axis.ends_at_tip()) rings.back().free = false;
  clear_ends(branch, rings, axis.periodic());
  return laid;
}

Vec3 RingLayer::direction_at(Index branch, double place) const {
  const BranchAxis& axis = axes_[branch];
  return axis.direction(place, kSmoothing * axis.at(place).radius);
}

void RingLayer::leave_out_steps(std::vector<Ring>& rings, std::vector<Vec3>& sides, double least_gap) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rings.size();) {
    sides[kept] = sides[k];
    rings[kept++] = rings[k];
    std::size_t next = k + 1;
    while (next < rings.size() && rings[next].clear && !rings[next].free) ++next;
    const bool skip = rings[k].free && next < rings.size() && rings[next].free && next > k + 1 &&
                      is_straight_between(rings[k], rings[next]) && apart(rings[k], rings[next], least_gap);
    k = skip ? next : k + 1;
  }
  rings.resize(kept);
  sides.resize(kept);
}

Rings RingLayer::spread(Index branch, const Rings& even, const std::vector<Vec3>& sides) const {
  const BranchAxis& axis = axes_[branch];
  const std::vector<Ring>& rings = even.rings;
  const double pitch = options_.pitch();
  const double step = axis.length_in_radii() / std::max(1.0, std::round(axis.length_in_radii() / pitch));
  Rings laid;
  laid.points.reserve(even.points.size());
  const auto keep = [&](Ring ring) {
    const std::size_t first = laid.points.size();
    laid.points.insert(laid.points.end(), ring.points.begin(), ring.points.end());
    ring.points = std::span(laid.points).subspan(first);
    laid.rings.push_back(ring);
  };
  for (std::size_t k = 0; k < rings.size();) {
    std::size_t end = k;
    while (end < rings.size() && rings[end].free &&
           (end == k || axis.radii_of(rings[end].place) - axis.radii_of(rings[end - 1].place) < kNoGap * step))
      ++end;
    const std::size_t before = laid.points.size();
    const std::vector<Ring> run = end > k + 1 ? spread_run(branch, std::span(rings).subspan(k, end - k), sides[k], step,
                                                           laid.elongation, laid.points)
                                              : std::vector<Ring>();
    laid.rings.insert(laid.rings.end(), run.begin(), run.end());
    if (run.empty()) laid.points.resize(before);
    end = std::max(end, k + 1);
    for (; k < end; ++k) {
      if (run.empty()) keep(rings[k]);
    }
  }
  clear_ends(branch, laid.rings, axis.periodic());
  return laid;
}

std::vector<Ring> RingLayer::spread_run(Index branch, std::span<const Ring> run, const Vec3& side, double step,
                                        ElongationProfile& profile, std::vector<RingPoint>& points) const {
  const BranchAxis& axis = axes_[branch];
  const ElongationProfile here = elongation_of_run(axis, run, step, options_);
  const std::vector<double> places = here.spread(step);
  if (places.size() >= run.size()) return {};
  std::vector<Ring> rings;
  Vec3 across = side;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const CrossSection next = section_at(axis, places[k]);
    if (k > 0) across = turned(across, rings.back().normal, next.normal);
    across = (across - across.dot(next.normal) * next.normal).normalized();
    rings.push_back(lay_one(branch, next, across, static_cast<double>(k % 2) / 2, points));
    Ring& ring = rings.back();
    ring.radii = places[k];
    ring.step = step;
    ring.elongation = here.at(places[k]);
    if (!ring.free || (k > 0 && !apart(rings[k - 1], ring, kMinSpacing * options_.pitch()))) return {};
  }
  profile.append(here, step);
  return rings;
}

std::vector<RingPoint> RingLayer::lifted(Index branch, const Ring& ring) const {
  std::vector<RingPoint> points(ring.points.begin(), ring.points.end());
  if (options_.placement == Placement::inscribed) return points;
  const double height = std::min((balanced_ring_radius(options_.around) - 1) * ring.radius,
                                 kShareOfLimit * options_.limit.at(ring.radius));
  const Index segment = segment_at(branch, ring);
  for (RingPoint& p : points) {
    const Vec3 way = (p.position - ring.center).normalized();
    const Vec3 gradient = field_.sample_fast(p.position, segment).gradient;  // as when it was laid
    p.position += height / std::max(kFacing, gradient.dot(way)) * way;
  }
  return points;
}

void RingLayer::clear_ends(Index branch, std::vector<Ring>& rings, bool loop) const {
  const std::size_t count = rings.size();
  const auto covered = [&](std::size_t k) { return !rings[k].free; };
  std::vector<RingPoint> points;
  points.reserve(static_cast<std::size_t>(options_.around));
  const auto can_dock = [&](const Ring& ring, bool after) {
    const Vec3 across = ring.points.front().position - ring.center;
    const CrossSection next = section_beside(axes_[branch], ring, after);
    points.clear();
    return lay_one(branch, next, (across - across.dot(next.normal) * next.normal).normalized(), 0, points).free;
  };
  const std::size_t laps = loop ? 2 * count : count;
  for (std::size_t k = 1; k < laps; ++k) {
    Ring& ring = rings[k % count];
    if (ring.free && covered((k - 1) % count)) ring.free = can_dock(ring, false);
  }
  for (std::size_t k = laps - 1; k-- > 0;) {
    Ring& ring = rings[k % count];
    if (ring.free && covered((k + 1) % count)) ring.free = can_dock(ring, true);
  }
}

// Direction from which angles are counted. It rotates with the centerline unless that is straight throughout.
Vec3 RingLayer::reference(Index branch, const Vec3& normal) const {
  const Centerline& centerline = field_.relations().centerline();
  const auto& nodes = axes_[branch].branch().nodes;
  Vec3 best = kStraight * normal.unitOrthogonal();
  const auto offer = [&](const Vec3& way) {
    const Vec3 across = way - way.dot(normal) * normal;
    if (across.norm() > best.norm() * (1 + kStraight)) best = across;
  };
  for (const Index end : {nodes.front(), nodes.back()}) {
    for (const Index s : centerline.incident_segments(end)) {
      offer((centerline.node(centerline.other_node(s, end)).position - centerline.node(end).position).normalized());
    }
  }
  for (const Index n : nodes) {
    offer((centerline.node(n).position - centerline.node(nodes.front()).position) / axes_[branch].length());
  }
  return best.normalized();
}

Ring RingLayer::lay_one(Index branch, const CrossSection& section, const Vec3& side, double phase,
                        std::vector<RingPoint>& points) const {
  const BranchAxis::Point axis = axes_[branch].at(section.place);
  Ring ring;
  static_cast<CrossSection&>(ring) = section;
  const Vec3 up = section.normal.cross(side);
  ring.clear = goes_through(branch, section) && is_clear(branch, section, axis, side, up);
  if (!ring.clear) return ring;
  const std::size_t first = points.size();
  for (int j = 0; j < options_.around; ++j) {
    const double angle = 2 * std::numbers::pi * (j + phase) / options_.around;
    RingPoint seen;
    if (!see(branch, ring, axis, std::cos(angle) * side + std::sin(angle) * up, seen)) {
      points.resize(first);
      return ring;
    }
    points.push_back(seen);
  }
  ring.points = std::span(points).subspan(first);
  ring.free = true;
  return ring;
}

Index RingLayer::segment_at(Index branch, const CrossSection& section) const {
  return axes_[branch].branch().segments[axes_[branch].at(section.place).nth];
}

bool RingLayer::see(Index branch, const Ring& ring, const BranchAxis::Point& axis, const Vec3& way,
                    RingPoint& seen) const {
  const Index segment = axes_[branch].branch().segments[axis.nth];
  const double near = on_boundary(options_) * ring.radius;
  double far = ring.radius;
  FieldSample s;
  for (int step = 0; step < kSteps; ++step) {
    s = field_.sample_fast(ring.center + far * way, segment);
    if (std::abs(s.distance) < near) break;
    const double slope = s.gradient.dot(way);
    if (slope < kFacing) return false;
    far -= s.distance / slope;
    if (!(far > kNearest * ring.radius && far < kFarthest * ring.radius)) return false;
  }
  if (!(std::abs(s.distance) < near) || s.gradient.dot(way) < kFacing) return false;
  seen = {ring.center + far * way, s.cone};
  return is_own(branch, ring, s);
}

bool RingLayer::is_own(Index branch, const CrossSection& section, const FieldSample& sample) const {
  const BranchPlace at = places_[sample.cone];
  if (at.branch != branch) return false;
  const BranchAxis& axis = axes_[branch];
  const double radius = std::max(section.radius, field_.relations().radius_at(sample.cone, sample.t));
  return axis.apart(axis.place_of(at.nth, sample.t), section.place) <= kOwnReach * radius;
}

// Whether the section's own part of the branch runs through the plane from back to front.
bool RingLayer::goes_through(Index branch, const CrossSection& section) const {
  const BranchAxis& axis = axes_[branch];
  for (int k = 1; k <= kPlacesThrough; ++k) {
    const double reach = kOwnReach * section.radius * k / kPlacesThrough;
    for (const double way : {-1.0, 1.0}) {
      const double place = section.place + way * reach;
      if (!axis.periodic() && (place < 0 || place > axis.length())) continue;
      if (way * (axis.at(place).position - section.center).dot(section.normal) < kThrough * reach) return false;
    }
  }
  return true;
}

// Whether `cone` reaches beyond the section's own part of the branch.
bool RingLayer::may_be_foreign(Index branch, const CrossSection& section, Index cone) const {
  return !is_own(branch, section, {0, {}, cone, 0}) || !is_own(branch, section, {0, {}, cone, 1});
}

bool RingLayer::is_clear(Index branch, const CrossSection& section, const BranchAxis::Point& axis, const Vec3& side,
                         const Vec3& up) const {
  const Index segment = axes_[branch].branch().segments[axis.nth];
  std::vector<Index> near, others;
  field_.local_cones_near(section.center, segment, kNeighbourhood * section.radius, near);
  for (const Index cone : near) {
    if (cone == segment || !may_be_foreign(branch, section, cone)) continue;
    if (field_.sample_cone(section.center, cone).distance < kNeighbourhood * section.radius) others.push_back(cone);
  }
  for (int j = 0; j < kDirections && !others.empty(); ++j) {
    const double angle = 2 * std::numbers::pi * j / kDirections;
    const Vec3 way = std::cos(angle) * side + std::sin(angle) * up;
    for (const auto& [far, space] : kClearances) {
      const Vec3 p = section.center + far * section.radius * way;
      for (const Index cone : others) {
        const FieldSample s = field_.sample_cone(p, cone);
        if (s.distance < space * section.radius && !is_own(branch, section, s)) return false;
      }
    }
  }
  return true;
}

}  // namespace vmesh
