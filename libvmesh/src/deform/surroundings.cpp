// Surroundings: instruments and jaws, and which pairs are near. The potential is in surroundings_energy.cpp.
#include "deform/surroundings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// Two vessels that are nearer along the tree than this many times the sum of their radii, and near at rest, never
/// touch: they are one vessel that bends.
constexpr double kNeighbours = 3;
/// The slack with which pairs are looked for: in mean radii, and in addition in ways that slots are about to go.
constexpr double kSlackInRadii = 0.25, kSlackInWays = 0.25;
/// The ways for which pairs are looked for at once, at most: in largest movements of the last step.
constexpr double kMostSteps = 30;
/// Stiffness of barriers, in E A / r of the segment: that of a bent vessel about ten radii long, as vessels give way by
/// bending. What presses harder comes nearer. At least what stops the mass of everything below within a step.
constexpr double kBarrier = 1e-3;
/// Stiffness of what stops pairs that run into each other, in the larger of E A / r and what stops the mass below.
constexpr double kStop = 100;
/// Gaps narrower than this share of a barrier's reach, which holds a hundred times what crushes a vessel, are kept.
constexpr double kNarrowestGap = 1e-5;
/// Jaws are this much stiffer than the segment that they hold.
constexpr double kJawFactor = 100;

SlotBox box_of(const RoundCone& cone, double around) {
  const Vec3 a = Vec3::Constant(cone.radius_a + around), b = Vec3::Constant(cone.radius_b + around);
  SlotBox box{cone.a - a, cone.a + a};
  box.include({cone.b - b, cone.b + b});
  return box;
}

void check_shape(const InstrumentShape& shape) {
  const auto fail = [](const std::string& what) { throw InvalidInput("instrument: " + what); };
  if (shape.points_mm.empty()) fail("it needs at least one point");
  if (shape.points_mm.size() != shape.radii_mm.size())
    fail("it has " + std::to_string(shape.points_mm.size()) + " points and " + std::to_string(shape.radii_mm.size()) +
         " radii; give one each");
  for (const Vec3& p : shape.points_mm)
    if (!p.allFinite()) fail("its points must be finite");
  for (const double r : shape.radii_mm)
    if (!(std::isfinite(r) && r > 0)) fail("its radii must be finite and above 0");
  if (!(shape.friction >= 0 && shape.friction <= 10)) fail("its friction must be in [0, 10]");
}

void check_pose(const InstrumentPose& pose) {
  if (!pose.position_mm.allFinite() || !pose.rotation.coeffs().allFinite() ||
      !(std::abs(pose.rotation.norm() - 1) < 1e-6))
    throw InvalidInput("instrument: its position must be finite and its rotation a unit quaternion");
}

void check_contact(const ContactOptions& o) {
  const auto fail = [](const char* what) { throw InvalidInput(std::string("contact: ") + what); };
  if (!(o.gap_ratio > 0 && o.gap_ratio <= 1)) fail("gap_ratio must be above 0, at most 1");
  if (!(o.friction >= 0 && o.friction <= 10)) fail("friction must be in [0, 10]");
  if (o.iterations < 1) fail("there must be at least 1 iteration");
  if (!(std::isfinite(o.slip_radii_per_s) && o.slip_radii_per_s > 0)) fail("slip_radii_per_s must be finite, above 0");
}

bool same(const InstrumentPose& a, const InstrumentPose& b) {
  return a.position_mm == b.position_mm && a.rotation.coeffs() == b.rotation.coeffs();
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0;
  return (p - a - t * way).norm();
}

}  // namespace

InstrumentPose between(const InstrumentPose& a, const InstrumentPose& b, double part) {
  if (part <= 0) return a;
  if (part >= 1) return b;
  return {a.position_mm + part * (b.position_mm - a.position_mm), a.rotation.slerp(part, b.rotation).normalized()};
}

InstrumentPose InstrumentPath::at(double time) const {
  std::size_t next = 0;
  while (next < time_s.size() && time_s[next] <= time) ++next;
  if (next == 0) return pose.front();
  if (next == time_s.size()) return pose.back();
  return between(pose[next - 1], pose[next], (time - time_s[next - 1]) / (time_s[next] - time_s[next - 1]));
}

Surroundings::Surroundings(const RodScene& scene, const ContactOptions& options) : boxes_(scene.size()) {
  const double step = scene.options.step_s;
  std::vector<double> mass(scene.size(), 0);  // of everything below a slot
  for (Index j = static_cast<Index>(scene.size()); j-- > 0;) {
    mass[j] += scene.rods[j].mass;
    if (!scene.is_root(j)) mass[scene.rods[j].parent] += mass[j];
  }
  for (Index j = 0; j < scene.size(); ++j) {
    const Rod& rod = scene.rods[j];
    parent_.push_back(rod.parent == kNone ? j : rod.parent);
    radius_.push_back(rod.radius);
    const double section = rod.stretch * std::max(rod.length / rod.radius, 1e-3);  // E A / r
    stiffness_.push_back(std::max(kBarrier * section, mass[j] / (step * step)));
    stop_stiffness_.push_back(kStop * std::max(section, mass[j] / (step * step)));
  }
  present_ = trial_ = start_ = scene.pose.position;
  slot_boxes_.resize(scene.size());
  load_of_slot_.assign(scene.size(), kNone);
  set_options(scene, options);
}

void Surroundings::carry_on(const Surroundings& before, const std::vector<SlotOrigin>& origin) {
  instruments_ = before.instruments_;
  parts_ = before.parts_;
  points_ = before.points_;
  jaws_ = before.jaws_;
  jaw_trial_ = before.jaw_trial_;
  last_way_ = before.last_way_;
  radius_ = carried(before.radius_, origin);
  std::map<std::pair<Index, Index>, double> excess;
  for (const RestPair& pair : before.rest_pairs_) excess[std::minmax(pair.a, pair.b)] = pair.excess;
  for (RestPair& pair : rest_pairs_) {
    const Index a = origin[pair.a].frame, b = origin[pair.b].frame;
    const auto found = excess.find(std::minmax(a, b));
    // Both were one segment, or as near as they were: parts of segments may be farther from each other at rest.
    if (a == b) pair.excess = HUGE_VAL;
    if (found != excess.end()) pair.excess = found->second;
  }
}

void Surroundings::set_options(const RodScene& scene, const ContactOptions& options) {
  check_contact(options);
  options_ = options;
  slack_ = -1;
  if (options.self) find_rest_pairs(scene);
}

Index Surroundings::add_instrument(const RodScene& scene, const InstrumentShape& shape, const InstrumentPose& pose) {
  check_shape(shape);
  check_pose(pose);
  const auto number = static_cast<Index>(instruments_.size());
  Instrument instrument{shape, pose, pose, pose, pose, points_.present.size(), {}};
  std::vector<Vec3> points = points_.present;
  points.resize(points.size() + shape.points_mm.size());
  write_points(pose, instrument, points);
  const std::size_t first = instrument.first_point, count = shape.points_mm.size(), old_parts = parts_.size();
  for (std::size_t i = 0; i < std::max<std::size_t>(count - 1, 1); ++i) {
    const std::size_t next = std::min(i + 1, count - 1);
    parts_.push_back({number, static_cast<Index>(first + i), static_cast<Index>(first + next), shape.radii_mm[i],
                      shape.radii_mm[next]});
  }
  for (std::size_t p = old_parts; p < parts_.size(); ++p)
    for (Index j = 0; j < scene.size(); ++j) {
      if (scene.is_root(j) && scene.rods[j].first_child != kNone) continue;
      const double gap = gap_between(cone_of(j, scene.pose.position), part_cone(static_cast<Index>(p), points)).gap;
      if (gap > 0) continue;
      parts_.resize(old_parts);
      const Index segment = scene.tree.segment[j];
      throw InvalidInput(
          "instrument: it overlaps " +
          (segment == kNone ? "node " + std::to_string(scene.tree.node[j]) : "segment " + std::to_string(segment)) +
          " by " + std::to_string(-gap) + " mm where it starts; start outside of the vessels");
    }
  instruments_.push_back(std::move(instrument));
  points_.present = points_.trial = points_.aim = points_.start = points;
  slack_ = -1;
  return number;
}

void Surroundings::aim_instrument(Index instrument, const InstrumentPose& pose) {
  check_pose(pose);
  instruments_[instrument].aim = pose;
  write_points(pose, instruments_[instrument], points_.aim);
}

Index Surroundings::add_jaw(const RodScene& scene, Index slot, double t, double slips_mN) {
  Jaw jaw;
  jaw.slot = slot, jaw.t = t, jaw.slips_mN = slips_mN;
  jaw.at = jaw.aim = jaw.start = on_slot(slot, t, scene.pose.position);
  jaw.stiffness =
      kJawFactor * std::max(scene.rods[slot].stretch, scene.rods[slot].mass / std::pow(scene.options.step_s, 2));
  jaws_.push_back(jaw);
  jaw_trial_.push_back(jaw.at);
  return static_cast<Index>(jaws_.size() - 1);
}

void Surroundings::write_points(const InstrumentPose& pose, const Instrument& instrument,
                                std::vector<Vec3>& points) const {
  const Mat3 turn = pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < instrument.shape.points_mm.size(); ++i)
    points[instrument.first_point + i] = turn * instrument.shape.points_mm[i] + pose.position_mm;
}

RoundCone Surroundings::cone_of(Index slot, const std::vector<Vec3>& positions) const {
  const Index parent = parent_[slot];
  return {positions[parent], positions[slot], radius_[parent], radius_[slot]};
}

RoundCone Surroundings::part_cone(Index part, const std::vector<Vec3>& points) const {
  const Part& p = parts_[part];
  return {points[p.a], points[p.b], p.radius_a, p.radius_b};
}

Vec3 Surroundings::on_slot(Index slot, double t, const std::vector<Vec3>& positions) const {
  return (1 - t) * positions[parent_[slot]] + t * positions[slot];
}

Vec3 Surroundings::on_part(Index part, double t, const std::vector<Vec3>& points) const {
  return (1 - t) * points[parts_[part].a] + t * points[parts_[part].b];
}

/// Pairs of vessels that are near at rest. Those that are also near along the tree never touch; others may come as
/// near as they were.
void Surroundings::find_rest_pairs(const RodScene& scene) {
  rest_pairs_.clear();
  const auto& at = scene.tree.position;
  for (Index j = 0; j < scene.size(); ++j)
    slot_boxes_[j] = box_of(cone_of(j, at), options_.gap_ratio * std::max(radius_[j], radius_[parent_[j]]));
  boxes_.refit(slot_boxes_);
  boxes_.visit_pairs(slot_boxes_, [&](Index a, Index b) {
    const RoundCone first = cone_of(a, at), second = cone_of(b, at);
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

void Surroundings::begin(const RodScene& scene) {
  present_ = scene.pose.position;
  points_.start = points_.present;
  moves_ = false;
  for (Instrument& i : instruments_) {
    i.start = i.at;
    moves_ = moves_ || !same(i.at, i.aim);
  }
  for (Jaw& jaw : jaws_) {
    jaw.start = jaw.at;
    moves_ = moves_ || (jaw.holds && jaw.at != jaw.aim);
  }
  set_radii(scene);
  expect(scene);
  trial_ = present_;
  note_friction(scene);
  near_slots_.clear();
  if (!moves_) return;
  for (const ContactPair& pair : pairs_)
    if (pair.is_part) near_slots_.push_back(pair.slot);
  for (const Jaw& jaw : jaws_)
    if (jaw.holds) near_slots_.push_back(jaw.slot);
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

/// The profile may widen a vessel only as far as there is room: a fifth of every gap remains.
void Surroundings::set_radii(const RodScene& scene) {
  const std::vector<double>& scale = scene.pose.radial_scale;
  if (scale.empty()) return;
  std::vector<double> wanted(radius_.size());
  bool changes = false, grows = false;
  for (std::size_t j = 0; j < radius_.size(); ++j) {
    wanted[j] = scene.rods[j].radius * scale[j];
    changes = changes || wanted[j] != radius_[j];
    grows = grows || wanted[j] > radius_[j];
  }
  if (!changes) return;
  if (grows) limit_radii(scene, wanted);
  radius_ = std::move(wanted);
  slack_ = -1;
}

void Surroundings::limit_radii(const RodScene& scene, std::vector<double>& wanted) {
  double most = 0;
  for (std::size_t j = 0; j < radius_.size(); ++j) most = std::max(most, wanted[j] - radius_[j]);
  find_pairs(scene, std::vector<Vec3>(present_.size(), Vec3::Zero()), most);
  std::vector<double> part(radius_.size(), 1);
  const auto growth = [&](Index j) {
    return std::max({0.0, wanted[j] - radius_[j], wanted[parent_[j]] - radius_[parent_[j]]});
  };
  for (const ContactPair& pair : pairs_) {
    const double both = growth(pair.slot) + (pair.is_part ? 0 : growth(pair.other));
    if (both <= 0.8 * pair.now.gap) continue;
    const auto limit = [&](Index j) {
      for (const Index end : {j, parent_[j]}) part[end] = std::min(part[end], 0.8 * pair.now.gap / both);
    };
    limit(pair.slot);
    if (!pair.is_part) limit(pair.other);
  }
  for (std::size_t j = 0; j < radius_.size(); ++j)
    if (wanted[j] > radius_[j]) wanted[j] = radius_[j] + part[j] * (wanted[j] - radius_[j]);
}

/// Whether all slots are within their slack of the same part of the ways for which pairs were found, and instruments
/// near theirs.
bool Surroundings::covers(const std::vector<Vec3>& positions, const std::vector<Vec3>& points) const {
  if (farthest(points) > slack_) return false;
  double along = 0, all = 0;
  for (std::size_t j = 0; j < positions.size(); ++j) {
    along += found_way_[j].dot(positions[j] - found_at_[j]);
    all += found_way_[j].squaredNorm();
  }
  const double part = all > 0 ? std::clamp(along / all, 0.0, 1.0) : 0;
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
  points_found_at_ = points_.present, points_found_aim_ = points_.aim;
  slot_slack_.resize(ways.size());
  for (std::size_t j = 0; j < ways.size(); ++j) slot_slack_[j] = slack + kSlackInWays * ways[j].norm();
  pairs_.clear();
  set_balls(present_);
  const double ratio = options_.gap_ratio;
  for (Index j = 0; j < present_.size(); ++j) {
    const double around = slack_of(j) + ratio * std::max(radius_[j], radius_[parent_[j]]);
    RoundCone cone = cone_of(j, present_);
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
  const RoundCone first = cone_of(slot, present_);
  const RoundCone second = is_part ? part_cone(other, points_.present) : cone_of(other, present_);
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

RoundCone Surroundings::second_cone(const ContactPair& pair, const std::vector<Vec3>& positions,
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

void Surroundings::try_part(double part) {
  for (Instrument& i : instruments_) {
    i.trial = between(i.at, i.aim, part);
    write_points(i.trial, i, points_.trial);
  }
  for (std::size_t i = 0; i < jaws_.size(); ++i) jaw_trial_[i] = jaws_[i].at + part * (jaws_[i].aim - jaws_[i].at);
}

Surroundings::PairMotion Surroundings::motion_of(const ContactPair& pair) const {
  PairMotion motion{{cone_of(pair.slot, present_), cone_of(pair.slot, trial_)},
                    {second_cone(pair, present_, points_.present), second_cone(pair, trial_, points_.trial)}};
  motion.first.from.radius_a -= pair.rest_excess, motion.first.from.radius_b -= pair.rest_excess;
  return motion;
}

double Surroundings::free_part_of(const ContactPair& pair) const {
  const PairMotion motion = motion_of(pair);
  return vmesh::free_part(motion.first, motion.second, pair.now.gap, kNarrowestGap * pair.barrier.reach);
}

double Surroundings::free_part(const RodScene& scene) {
  double part = cover_trial(scene);
  for (const ContactPair& pair : pairs_) part = std::min(part, free_part_of(pair));
  return part;
}

void Surroundings::accept() {
  expects_ = false;
  for (ContactPair& pair : pairs_) pair.now = pair.next;
  for (Instrument& i : instruments_) i.at = i.trial;
  points_.present = points_.trial;
  for (std::size_t i = 0; i < jaws_.size(); ++i) jaws_[i].at = jaw_trial_[i];
  present_ = trial_;
}

HandForce Surroundings::jaw_force(Index jaw) const {
  const Jaw& j = jaws_[jaw];
  HandForce force;
  force.holds = j.holds;
  if (!j.holds) return force;
  force.behind_mm = (j.aim - j.at).norm();
  const Vec3 way = on_slot(j.slot, j.t, present_) - j.at;
  force.force_N = 1e-3 * j.slope_over_way(way.norm()) * way;
  return force;
}

}  // namespace vmesh
