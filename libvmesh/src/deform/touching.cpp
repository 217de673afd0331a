#include "deform/touching.h"

#include <cmath>
#include <string>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

[[noreturn]] void fail_touching(const std::string& what) { throw InvalidInput("simulation: " + what); }

void require_index(Index number, std::size_t count, const std::string& what) {
  if (number < count) return;
  fail_touching("there is no " + what + " " + std::to_string(number) + "; there are " + std::to_string(count) +
                ", counted from 0");
}

}  // namespace

Touching::Touching(const Centerline& centerline, RodScene& scene, ImplicitRods& rods) : scene_(scene), rods_(rods) {
  const RodTree& tree = scene.tree;
  for (Index s = 0; s < centerline.segments().size(); ++s)
    backwards_.push_back(tree.node[tree.slot_of_segment[s]] == centerline.segment(s).a ? 1 : 0);
}

Surroundings& Touching::around() {
  if (scene_.options.integrator != Integrator::implicit)
    fail_touching("contact, jaws and tissue need the integrator implicit; the paper's procedure has none of them");
  if (!around_) {
    around_ = std::make_unique<Surroundings>(scene_, ContactOptions{});
    rods_.attach(scene_, *around_);
  }
  return *around_;
}

void Touching::carry_on(const Touching& before, const CenterlineCut& cut, const std::vector<SlotOrigin>& origin) {
  if (!before.around_) return;
  around_ = std::make_unique<Surroundings>(scene_, before.around_->options());
  rods_.attach(scene_, *around_);
  around_->carry_on(*before.around_, origin);
  for (Jaw& jaw : around_->jaws()) put_jaw(before, cut, jaw);
  carry_tissue(before, cut, origin);
}

void Touching::put_jaw(const Touching& before, const CenterlineCut& cut, Jaw& jaw) const {
  const Index segment = before.scene_.tree.segment[jaw.slot];
  const SegmentPlace place = cut.after({segment, before.backwards_[segment] ? 1 - jaw.t : jaw.t});
  jaw.slot = scene_.tree.slot_of_segment[place.segment];
  jaw.t = backwards_[place.segment] ? 1 - place.t : place.t;
}

bool Touching::is_torn(Index slot) const { return spring_of(slot).exists() && !around_->tissue.springs[slot].exists(); }

/// Both parts of a segment have its tissue. What has torn stays so; a new end is torn if both of its neighbours are.
void Touching::carry_tissue(const Touching& before, const CenterlineCut& cut, const std::vector<SlotOrigin>& origin) {
  tissue_ = before.tissue_;
  if (before.around_->tissue.springs.empty()) return;
  if (!cut.between_segments) tissue_.push_back(tissue_[cut.at.segment]);
  around_->tissue.torn = before.around_->tissue.torn;
  for (Index j = 0; j < scene_.size(); ++j) {
    const bool torn = before.is_torn(origin[j].a) && before.is_torn(origin[j].b);
    rods_.set_tissue(scene_, j, torn ? TissueSpring{} : spring_of(j));
  }
}

Index Touching::slot_of(Index segment) const {
  require_index(segment, backwards_.size(), "segment");
  return scene_.tree.slot_of_segment[segment];
}

void Touching::set_contact(const ContactOptions& options) {
  around().set_options(scene_, options);
  rods_.wake_all();
}

Index Touching::add_instrument(const InstrumentShape& shape, const InstrumentPose& pose) {
  return around().add_instrument(scene_, shape, pose);
}

double Touching::room_for(const InstrumentShape& shape, const InstrumentPose& pose) const {
  if (around_) return around_->room_for(scene_, shape, pose);
  return Surroundings(scene_, ContactOptions{}).room_for(scene_, shape, pose);
}

void Touching::require_instrument(Index number) const {
  require_index(number, around_ ? around_->instrument_count() : 0, "instrument");
  if (!around_->is_there(number)) fail_touching("instrument " + std::to_string(number) + " has been removed");
}

void Touching::remove_instrument(Index instrument) {
  require_instrument(instrument);
  for (const Index slot : around_->remove_instrument(instrument)) rods_.wake(slot);
}

void Touching::move_instrument(Index instrument, const InstrumentPose& pose) {
  require_instrument(instrument);
  around_->aim_instrument(instrument, pose);
}

Index Touching::grasp(Index segment, double t, double slips_N) {
  const Index slot = slot_of(segment);
  if (!(t >= 0 && t <= 1)) fail_touching("the parameter of a grasped place must be in [0, 1]");
  if (!(slips_N > 0)) fail_touching("the force above which jaws slip must be above 0");
  const Index jaw = around().add_jaw(scene_, slot, backwards_[segment] ? 1 - t : t, 1e3 * slips_N);
  rods_.wake(slot);
  return jaw;
}

const Jaw& Touching::jaw(Index number) const {
  require_index(number, around_ ? around_->jaws().size() : 0, "jaw");
  return around_->jaws()[number];
}

void Touching::move_jaw(Index number, const Vec3& position_mm) {
  jaw(number);
  if (!position_mm.allFinite()) fail_touching("the position of jaws must be finite");
  around_->jaws()[number].aim = position_mm;
}

void Touching::open_jaw(Index number) {
  rods_.wake(jaw(number).slot);
  around_->jaws()[number].holds = false;
}

/// A slot has half of the springs of each of its segments.
TissueSpring Touching::spring_of(Index slot) const {
  const RodTree& tree = scene_.tree;
  TissueSpring spring{0, 0, tree.position[slot]};
  const auto add = [&](Index j) {
    if (tree.segment[j] == kNone) return;
    const TissueProperties& tissue = tissue_[tree.segment[j]];
    if (!(tissue.stiffness_N_mm2 > 0)) return;
    spring.stiffness += 0.5e3 * tree.length[j] * tissue.stiffness_N_mm2;
    spring.tear += 0.5e3 * tree.length[j] * tissue.tear_N_mm;
  };
  add(slot);
  for (Index c = scene_.rods[slot].first_child; c != kNone; c = scene_.rods[c].next_sibling) add(c);
  return spring;
}

void Touching::set_tissue(Index segment, const TissueProperties& tissue) {
  const Index slot = slot_of(segment);
  if (!(std::isfinite(tissue.stiffness_N_mm2) && tissue.stiffness_N_mm2 >= 0))
    fail_touching("the stiffness of tissue must be finite and at least 0");
  if (!(tissue.tear_N_mm > 0)) fail_touching("the force at which tissue tears must be above 0");
  around();
  tissue_.resize(backwards_.size());
  tissue_[segment] = tissue;
  for (const Index end : {slot, scene_.rods[slot].parent}) rods_.set_tissue(scene_, end, spring_of(end));
}

Vec3 Touching::jaw_position(Index number) const { return jaw(number).at; }

HandForce Touching::drag_force(Index slot) const {
  HandForce force;
  // What holds the slot pushes it; the slot pulls the other way.
  force.force_N = -1e-3 * rods_.holding_force(scene_, slot);
  force.behind_mm = (scene_.target[slot] - scene_.pose.position[slot]).norm();
  force.holds = scene_.hold[slot] != Hold::free;
  if (!force.holds) force.behind_mm = 0;
  return force;
}

InstrumentPose Touching::instrument_pose(Index instrument) const {
  require_instrument(instrument);
  return around_->instrument_pose(instrument);
}

HandForce Touching::instrument_force(Index instrument) const {
  require_instrument(instrument);
  return around_->instrument_force(instrument);
}

HandForce Touching::jaw_force(Index number) const {
  jaw(number);
  return around_->jaw_force(number);
}

double Touching::energy_J() const {
  if (!around_) return 0;
  double energy = around_->stored();
  const std::vector<TissueSpring>& springs = around_->tissue.springs;
  for (std::size_t j = 0; j < springs.size(); ++j) energy += springs[j].energy(scene_.pose.position[j]);
  return 1e-6 * energy;
}

}  // namespace vmesh
