// Surroundings: which pairs are near.
#include <algorithm>
#include <cmath>

#include "deform/surroundings.h"

namespace vmesh {
namespace {

/// Two vessels that are nearer along the tree than this many times the sum of their radii, and near at rest, never
/// touch: they are one vessel that bends.
constexpr double kNeighbours = 3;
/// The slack with which pairs are looked for: in mean radii, and in addition in ways that slots are about to go.
constexpr double kSlackInRadii = 0.25, kSlackInWays = 0.25;
/// The ways for which pairs are looked for at once, at most: in largest movements of the last step.
constexpr double kMostSteps = 30;

SlotBox box_of(const ContactCone& cone, double around) {
  const Vec3 a = Vec3::Constant(cone.radius_a + around), b = Vec3::Constant(cone.radius_b + around);
  SlotBox box{cone.a - a, cone.a + a};
  box.include({cone.b - b, cone.b + b});
  return box;
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0;
  return (p - a - t * way).norm();
}

}  // namespace

/// Pairs of vessels that are near at rest. Those that are also near along the tree never touch; others may come as
/// near as they were.
void Surroundings::find_rest_pairs(const RodScene& scene) {
  rest_pairs_.clear();
  const auto& at = scene.tree.position;
  for (Index j = 0; j < scene.size(); ++j)
    slot_boxes_[j] = box_of(cone_of(j, at), options_.gap_ratio * std::max(radius_[j], radius_[parent_[j]]));
  boxes_.refit(slot_boxes_);
  boxes_.visit_pairs(slot_boxes_, [&](Index a, Index b) {
    const ContactCone first = cone_of(a, at), second = cone_of(b, at);
    const double gap = gap_between(first, second).gap;
    const double radii = std::max(first.radius_a, first.radius_b) + std::max(second.radius_a, second.radius_b);
    const double reach =
        options_.gap_ratio * std::min({first.radius_a, first.radius_b, second.radius_a, second.radius_b});
    if (gap >= reach) return;
    const bool never = are_neighbours(scene, a, b, kNeighbours * radii);
    rest_pairs_.push_back({a, b, never ? HUGE_VAL : reach - gap});
  });
  std::sort(rest_pairs_.begin(), rest_pairs_.end(),
            [](const RestPair& x, const RestPair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
}

/// Whether the tree between the nearer ends of two segments is at most this long. Where a loop was cut, only the
/// segments' own ends count as one.
bool Surroundings::are_neighbours(const RodScene& scene, Index a, Index b, double most) const {
  const RodTree& tree = scene.tree;
  const auto path = [&](Index x, Index y) {
    double length = tree.node[x] == tree.node[y] ? -HUGE_VAL : 0;
    while (x != y && length <= most) {
      if (x < y) std::swap(x, y);  // parents come before children
      if (tree.parent[x] == kNone) return HUGE_VAL;
      length += tree.length[x];
      x = tree.parent[x];
    }
    return length;
  };
  for (const Index x : {a, parent_[a]})
    for (const Index y : {b, parent_[b]})
      if (path(x, y) <= most) return true;
  return false;
}

double Surroundings::rest_excess(Index a, Index b) const {
  const auto found = std::lower_bound(rest_pairs_.begin(), rest_pairs_.end(), std::pair(a, b),
                                      [](const RestPair& x, const std::pair<Index, Index>& y) {
                                        return x.a != y.first ? x.a < y.first : x.b < y.second;
                                      });
  return found != rest_pairs_.end() && found->a == a && found->b == b ? found->excess : 0;
}

/// Finds pairs anew if slots have left the places for which they were found.
void Surroundings::expect(const RodScene& scene) {
  double way = 0, speed = 0, pulled = 0;
  for (std::size_t j = 0; j < present_.size(); ++j) {
    way = std::max(way, (present_[j] - start_[j]).squaredNorm());
    speed = std::max(speed, scene.velocity[j].squaredNorm());
    if (scene.hold[j] != Hold::free) pulled = std::max(pulled, (scene.target[j] - present_[j]).squaredNorm());
  }
  for (std::size_t p = 0; p < points_.aim.size(); ++p)
    pulled = std::max(pulled, (points_.aim[p] - points_.present[p]).squaredNorm());
  for (const Jaw& jaw : jaws_) pulled = std::max(pulled, (jaw.aim - jaw.at).squaredNorm());
  start_ = present_;
  last_way_ = std::max({std::sqrt(way), scene.options.step_s * std::sqrt(speed), std::sqrt(pulled), 0.5 * last_way_});
  expected_way_ = std::max(least_slack(), last_way_);
  if (slack_ >= 0 && covers(present_, points_.aim))
    note_gaps();
  else
    find_pairs(scene, std::vector<Vec3>(present_.size(), Vec3::Zero()), least_slack());
}

double Surroundings::least_slack() const {
  double sum = 0;
  for (const double r : radius_) sum += r;
  return kSlackInRadii * sum / static_cast<double>(radius_.size());
}

/// Whether all slots are within their slack of the same part of the ways for which pairs were found, and instruments
/// near theirs.
bool Surroundings::covers(const std::vector<Vec3>& positions, const std::vector<Vec3>& points) const {
  if (farthest(points) > slack_) return false;
  double part = 0;
  if (found_ways_squared_ > 0) {
    double along = 0;
    for (std::size_t j = 0; j < positions.size(); ++j) along += found_way_[j].dot(positions[j] - found_at_[j]);
    part = std::clamp(along / found_ways_squared_, 0.0, 1.0);
  }
  for (std::size_t j = 0; j < positions.size(); ++j)
    if ((positions[j] - found_at_[j] - part * found_way_[j]).squaredNorm() > slot_slack_[j] * slot_slack_[j])
      return false;
  return true;
}

double Surroundings::farthest(const std::vector<Vec3>& points) const {
  double far = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    far = std::max(far, distance_to_line(points[p], points_found_at_[p], points_found_aim_[p]));
  return far;
}

/// Has all pairs that may meet on the way to the trial; returns for how much of that way.
double Surroundings::cover_trial(const RodScene& scene) {
  if (covers(trial_, points_.trial)) return 1;
  std::vector<Vec3> ways(present_.size());
  double way = 0;
  for (std::size_t j = 0; j < ways.size(); ++j) {
    ways[j] = trial_[j] - present_[j];
    way = std::max(way, ways[j].norm());
  }
  double part = way > kMostSteps * expected_way_ ? kMostSteps * expected_way_ / way : 1;
  for (Vec3& w : ways) w *= part;
  find_pairs(scene, ways, least_slack());
  const double far = farthest(points_.trial);
  if (far > slack_) part = std::min(part, slack_ / far);
  return part;
}

/// All pairs that can come within reach while slots go any part of these ways, the same for all of them, and leave them
/// by no more than `slack` and a share of the way; instruments the way to where they aim.
void Surroundings::find_pairs(const RodScene& scene, const std::vector<Vec3>& ways, double slack) {
  slack_ = slack;
  found_at_ = present_, found_way_ = ways;
  found_ways_squared_ = 0;
  for (const Vec3& way : ways) found_ways_squared_ += way.squaredNorm();
  points_found_at_ = points_.present, points_found_aim_ = points_.aim;
  slot_slack_.resize(ways.size());
  for (std::size_t j = 0; j < ways.size(); ++j) slot_slack_[j] = slack + kSlackInWays * ways[j].norm();
  pairs_.clear();
  set_balls(present_);
  const double ratio = options_.gap_ratio;
  for (Index j = 0; j < present_.size(); ++j) {
    const double around = slack_of(j) + ratio * std::max(radius_[j], radius_[parent_[j]]);
    ContactCone cone = cone_of(j, present_);
    slot_boxes_[j] = box_of(cone, around);
    cone.a += ways[parent_[j]], cone.b += ways[j];
    slot_boxes_[j].include(box_of(cone, around));
  }
  boxes_.refit(slot_boxes_);
  for (Index p = 0; p < parts_.size(); ++p) {
    SlotBox box = box_of(part_cone(p, points_.present), slack);
    box.include(box_of(part_cone(p, points_.aim), slack));
    boxes_.visit_overlapping(slot_boxes_, box, [&](Index j) { add_pair(scene, j, p, true); });
  }
  if (options_.self)
    boxes_.visit_pairs(slot_boxes_, [&](Index a, Index b) {
      if (may_meet(a, b)) add_pair(scene, a, b, false);
    });
}

double Surroundings::slack_of(Index slot) const { return std::max(slot_slack_[slot], slot_slack_[parent_[slot]]); }

/// By balls around two slots and how differently they go.
bool Surroundings::may_meet(Index a, Index b) const {
  const double reach = options_.gap_ratio * std::max(radius_[a], radius_[parent_[a]]);
  return ball_gap(a, b) - nearing(a, b) < reach;
}

/// How much nearer two slots can come to each other than where they are, while covered.
double Surroundings::nearing(Index a, Index b) const {
  const Vec3 &a0 = found_way_[parent_[a]], &a1 = found_way_[a], &b0 = found_way_[parent_[b]], &b1 = found_way_[b];
  const Vec3 common = 0.25 * (a0 + a1 + b0 + b1);
  const auto longest = [&](const Vec3& x, const Vec3& y) {
    return std::sqrt(std::max((x - common).squaredNorm(), (y - common).squaredNorm()));
  };
  return longest(a0, a1) + longest(b0, b1) + slack_of(a) + slack_of(b);
}

void Surroundings::add_pair(const RodScene& scene, Index slot, Index other, bool is_part) {
  const auto only_a_root = [&](Index j) { return scene.is_root(j) && scene.rods[j].first_child != kNone; };
  if (only_a_root(slot) || (!is_part && only_a_root(other))) return;
  const double excess = is_part ? 0 : rest_excess(slot, other);
  if (std::isinf(excess)) return;
  const ContactCone first = cone_of(slot, present_);
  const ContactCone second = is_part ? part_cone(other, points_.present) : cone_of(other, present_);
  const double smallest = std::min({first.radius_a, first.radius_b, second.radius_a, second.radius_b});
  const double stiffness = is_part ? stiffness_[slot] : std::min(stiffness_[slot], stiffness_[other]);
  ContactPair pair{slot, other, is_part, {stiffness, options_.gap_ratio * smallest}, excess, {}, {}};
  pair.now = pair.next = gap_of(pair, present_, points_.present);
  if (!is_part && pair.now.gap - nearing(slot, other) >= pair.barrier.reach) return;
  pairs_.push_back(pair);
}

void Surroundings::set_balls(const std::vector<Vec3>& positions) {
  if (!options_.self) return;
  balls_.resize(positions.size());
  for (Index j = 0; j < positions.size(); ++j) {
    const Vec3 &a = positions[parent_[j]], &b = positions[j];
    balls_[j] = {0.5 * (a + b), 0.5 * (b - a).norm() + std::max(radius_[j], radius_[parent_[j]])};
  }
}

double Surroundings::ball_gap(Index a, Index b) const {
  return (balls_[a].middle - balls_[b].middle).norm() - balls_[a].radius - balls_[b].radius;
}

void Surroundings::note_gaps() {
  set_balls(present_);
  for (ContactPair& pair : pairs_) pair.now = gap_or_less(pair, present_, points_.present);
}

ContactCone Surroundings::second_cone(const ContactPair& pair, const std::vector<Vec3>& positions,
                                      const std::vector<Vec3>& points) const {
  return pair.is_part ? part_cone(pair.other, points) : cone_of(pair.other, positions);
}

ConeGap Surroundings::gap_of(const ContactPair& pair, const std::vector<Vec3>& positions,
                             const std::vector<Vec3>& points) const {
  ConeGap gap = gap_between(cone_of(pair.slot, positions), second_cone(pair, positions, points));
  gap.gap += pair.rest_excess;
  return gap;
}

/// Of vessels beyond their reach, a lower bound with set_balls() will do.
ConeGap Surroundings::gap_or_less(const ContactPair& pair, const std::vector<Vec3>& positions,
                                  const std::vector<Vec3>& points) const {
  if (!pair.is_part) {
    ConeGap bound;
    bound.gap = ball_gap(pair.slot, pair.other) + pair.rest_excess;
    if (bound.gap > pair.barrier.reach) return bound;
  }
  return gap_of(pair, positions, points);
}

}  // namespace vmesh
