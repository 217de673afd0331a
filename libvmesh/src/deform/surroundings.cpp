// Surroundings: instruments, jaws, and how they go with a step. Which pairs are near is in surroundings_pairs.cpp, the
// potential in surroundings_energy.cpp.
#include "deform/surroundings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "vmesh/core/error.h"

#include "deform/instrument_checks.h"

namespace vmesh {
namespace {

/// Stiffness of barriers, in E A / r of the segment: that of a bent vessel about ten radii long, as vessels give way by
/// bending (ten times that takes 1.5 times the iterations where instruments press). What presses harder comes nearer.
/// At least what stops the mass of everything below within a step, when it comes from about thirty times the reach: of
/// soft vessels that fall, gaps close step by step otherwise.
constexpr double kBarrier = 1e-3, kBarrierOfMass = 30;
/// Stiffness of what stops pairs that run into each other, in the larger of E A / r and what stops the mass below.
constexpr double kStop = 100;
/// Gaps narrower than this share of a barrier's reach, which holds a hundred times what crushes a vessel, are kept.
constexpr double kNarrowestGap = 1e-4;
/// Jaws are this much stiffer than the segment that they hold.
constexpr double kJawFactor = 100;

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

void write_points(const InstrumentPose& pose, const InstrumentShape& shape, Vec3* points) {
  const Mat3 turn = pose.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < shape.points_mm.size(); ++i) points[i] = turn * shape.points_mm[i] + pose.position_mm;
}

std::vector<Vec3> placed_points(const InstrumentShape& shape, const InstrumentPose& pose) {
  std::vector<Vec3> points(shape.points_mm.size());
  write_points(pose, shape, points.data());
  return points;
}

/// Its parts; of one point, a ball.
std::vector<ContactCone> cones_of(const InstrumentShape& shape, const InstrumentPose& pose) {
  const std::vector<Vec3> points = placed_points(shape, pose);
  std::vector<ContactCone> cones;
  for (std::size_t i = 0; i < std::max<std::size_t>(points.size() - 1, 1); ++i) {
    const std::size_t next = std::min(i + 1, points.size() - 1);
    cones.push_back({points[i], points[next], shape.radii_mm[i], shape.radii_mm[next]});
  }
  return cones;
}

}  // namespace

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
    stiffness_.push_back(std::max(kBarrier * section, kBarrierOfMass * mass[j] / (step * step)));
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

Surroundings::Nearest Surroundings::nearest_to(const RodScene& scene, const ContactCone& part) const {
  Nearest nearest;
  for (Index j = 0; j < scene.size(); ++j) {
    if (scene.is_root(j) && scene.rods[j].first_child != kNone) continue;
    const double gap = gap_between(cone_of(j, scene.pose.position), part).gap;
    if (gap < nearest.gap) nearest = {j, gap};
  }
  return nearest;
}

double Surroundings::room_for(const RodScene& scene, const InstrumentShape& shape, const InstrumentPose& pose) const {
  check_shape(shape);
  check_pose(pose);
  double room = HUGE_VAL;
  for (const ContactCone& part : cones_of(shape, pose)) room = std::min(room, nearest_to(scene, part).gap);
  return room;
}

Index Surroundings::add_instrument(const RodScene& scene, const InstrumentShape& shape, const InstrumentPose& pose) {
  check_shape(shape);
  check_pose(pose);
  for (const ContactCone& part : cones_of(shape, pose)) {
    const auto [slot, gap] = nearest_to(scene, part);
    if (gap > 0) continue;
    const Index segment = scene.tree.segment[slot];
    throw InvalidInput(
        "instrument: it overlaps " +
        (segment == kNone ? "node " + std::to_string(scene.tree.node[slot]) : "segment " + std::to_string(segment)) +
        " by " + std::to_string(-gap) + " mm where it starts; start outside of the vessels");
  }
  const auto number = static_cast<Index>(instruments_.size());
  const std::size_t first = points_.present.size(), count = shape.points_mm.size();
  for (std::size_t i = 0; i < std::max<std::size_t>(count - 1, 1); ++i) {
    const std::size_t next = std::min(i + 1, count - 1);
    parts_.push_back({number, static_cast<Index>(first + i), static_cast<Index>(first + next), shape.radii_mm[i],
                      shape.radii_mm[next]});
  }
  instruments_.push_back({shape, pose, pose, pose, pose, first, {}});
  const std::vector<Vec3> points = placed_points(shape, pose);
  for (std::vector<Vec3>* all : {&points_.present, &points_.trial, &points_.aim, &points_.start})
    all->insert(all->end(), points.begin(), points.end());
  slack_ = -1;
  return number;
}

/// Of contacts in the order of parts: those of the parts `first` to before `last` go, the others' parts are fewer.
template <class Touch>
void Surroundings::forget_parts(std::vector<Touch>& touches, Index first, Index last) const {
  std::erase_if(touches, [&](const Touch& t) { return t.is_part && t.other >= first && t.other < last; });
  for (Touch& t : touches)
    if (t.is_part && t.other >= last) t.other -= last - first;
}

std::vector<Index> Surroundings::remove_instrument(Index number) {
  const auto is_of = [&](const Part& part) { return part.instrument == number; };
  const auto begin = std::find_if(parts_.begin(), parts_.end(), is_of);
  const auto end = std::find_if_not(begin, parts_.end(), is_of);
  const auto first = static_cast<Index>(begin - parts_.begin()), last = static_cast<Index>(end - parts_.begin());
  std::vector<Index> near;
  for (const ContactPair& pair : pairs_)
    if (pair.is_part && pair.other >= first && pair.other < last) near.push_back(pair.slot);
  forget_parts(pairs_, first, last);
  forget_parts(rubs_, first, last);
  parts_.erase(begin, end);
  Instrument& instrument = instruments_[number];
  aim_instrument(number, instrument.at);
  instrument.force = {};
  instrument.gone = true;
  slack_ = -1;
  return near;
}

void Surroundings::aim_instrument(Index instrument, const InstrumentPose& pose) {
  check_pose(pose);
  instruments_[instrument].aim = pose;
  write_points(pose, instruments_[instrument].shape, &points_.aim[instruments_[instrument].first_point]);
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

ContactCone Surroundings::cone_of(Index slot, const std::vector<Vec3>& positions) const {
  const Index parent = parent_[slot];
  return {positions[parent], positions[slot], radius_[parent], radius_[slot]};
}

ContactCone Surroundings::part_cone(Index part, const std::vector<Vec3>& points) const {
  const Part& p = parts_[part];
  return {points[p.a], points[p.b], p.radius_a, p.radius_b};
}

Vec3 Surroundings::on_slot(Index slot, double t, const std::vector<Vec3>& positions) const {
  return (1 - t) * positions[parent_[slot]] + t * positions[slot];
}

Vec3 Surroundings::on_part(Index part, double t, const std::vector<Vec3>& points) const {
  return (1 - t) * points[parts_[part].a] + t * points[parts_[part].b];
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

void Surroundings::try_part(double part) {
  for (Instrument& i : instruments_) {
    i.trial = between(i.at, i.aim, part);
    write_points(i.trial, i.shape, &points_.trial[i.first_point]);
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
  const double reach = pair.barrier.reach;
  return vmesh::free_part(motion.first, motion.second, pair.now.gap, {kNarrowestGap * reach, reach});
}

double Surroundings::free_part(const RodScene& scene) {
  double part = cover_trial(scene);
  for (const ContactPair& pair : pairs_) part = std::min(part, free_part_of(pair));
  return part;
}

void Surroundings::go_alone() {
  if (!moves_) return;
  try_part(1);
  for (Instrument& i : instruments_) {
    i.at = i.trial;
    i.force = {};
  }
  points_.present = points_.trial;
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
