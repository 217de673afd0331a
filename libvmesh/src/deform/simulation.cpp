#include "vmesh/deform/simulation.h"

#include <cmath>
#include <string>

#include "vmesh/core/error.h"

#include "deform/cut_rods.h"
#include "deform/implicit_rods.h"
#include "deform/paper_rods.h"
#include "deform/profile.h"
#include "deform/rod_scene.h"
#include "deform/touching.h"

namespace vmesh {
namespace {

void check(const SimulationOptions& o) {
  const auto fail = [](const std::string& what) { throw InvalidInput("simulation: " + what); };
  const auto rate = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!(std::isfinite(o.step_s) && o.step_s > 0)) fail("the step (s) must be finite and above 0");
  if (o.iterations < 1) fail("there must be at least 1 iteration a step");
  if (!o.gravity_mm_s2.allFinite()) fail("gravity must be finite");
  if (!rate(o.drag_per_s)) fail("the drag (1/s) must be finite and at least 0");
  if (!rate(o.squeeze_response_s)) fail("the response to a squeeze (s) must be finite and at least 0");
  if (!rate(o.rest_tolerance)) fail("the tolerance of rest must be finite and at least 0");
  if (o.rest_steps < 1 || o.rest_steps > 100) fail("the steps until rest must be 1 to 100");
  if (o.paper.substeps < 0) fail("the substeps must be at least 0");
}

void require_finite(const Vec3& v, const char* name) {
  if (!v.allFinite()) throw InvalidInput(std::string("simulation: ") + name + " must be finite");
}

}  // namespace

struct CenterlineSimulation::State {
  State(const Centerline& centerline, const std::vector<SegmentProperties>& of_segments,
        const SimulationOptions& options)
      : properties(of_segments),
        scene(make_rod_scene(centerline, properties, options)),
        implicit(scene),
        paper(scene),
        profile(centerline, properties, options),
        touching(centerline, scene, implicit) {}

  State(const State& before, const CenterlineCut& cut)
      : properties(cut_properties(before.properties, cut)),
        scene(cut_scene(before.scene, cut, properties)),
        implicit(scene),
        paper(scene),
        profile(cut.centerline, properties, scene.options),
        touching(cut.centerline, scene, implicit) {
    const std::vector<SlotOrigin> origin = slot_origins(before.scene.tree, scene.tree, cut);
    profile.carry_on(before.profile, origin);
    paper.carry_on(before.paper, before.scene, scene, origin);
    touching.carry_on(before.touching, cut, origin);
  }

  Index slot(Index node) const {
    if (node >= scene.tree.slot_of_node.size())
      throw InvalidInput("simulation: there is no node " + std::to_string(node) + "; the nodes are 0 to " +
                         std::to_string(scene.tree.slot_of_node.size() - 1));
    return scene.tree.slot_of_node[node];
  }

  /// Wakes the node's slots after a change.
  Index stir(Index node) {
    const Index j = slot(node);
    implicit.wake(j);
    return j;
  }

  /// Setting the same value again does not wake slots at rest.
  void load(Index node, const Vec3& value, std::vector<Vec3>& loads) {
    const Index j = slot(node);
    if (loads[j] == value) return;
    stir(node);
    loads[j] = value;
  }

  void hold(Index node, Hold how) {
    const Index j = stir(node);
    scene.hold[j] = how;
    scene.target[j] = scene.pose.position[j];
    scene.velocity[j].setZero();
    if (how == Hold::clamped) scene.spin[j].setZero();
  }

  std::vector<SegmentProperties> properties;
  RodScene scene;
  ImplicitRods implicit;
  PaperRods paper;
  Profile profile;
  Touching touching;
};

CenterlineSimulation::CenterlineSimulation(const Centerline& centerline,
                                           const std::vector<SegmentProperties>& properties,
                                           const SimulationOptions& options) {
  check(options);
  state_ = std::make_unique<State>(centerline, properties, options);
}

CenterlineSimulation::~CenterlineSimulation() = default;
CenterlineSimulation::CenterlineSimulation(CenterlineSimulation&&) noexcept = default;
CenterlineSimulation& CenterlineSimulation::operator=(CenterlineSimulation&&) noexcept = default;

void CenterlineSimulation::fix(Index node) { state_->hold(node, Hold::fixed); }

void CenterlineSimulation::clamp(Index node) { state_->hold(node, Hold::clamped); }

void CenterlineSimulation::release(Index node) { state_->scene.hold[state_->stir(node)] = Hold::free; }

void CenterlineSimulation::drag(Index node, const Vec3& position_mm) {
  require_finite(position_mm, "the position to drag to");
  const Index j = state_->slot(node);
  if (state_->scene.hold[j] != Hold::free && position_mm == state_->scene.target[j]) return;
  state_->stir(node);
  if (state_->scene.hold[j] == Hold::free) state_->scene.hold[j] = Hold::fixed;
  state_->scene.target[j] = position_mm;
}

void CenterlineSimulation::set_force(Index node, const Vec3& force_N) {
  require_finite(force_N, "a force");
  state_->load(node, 1e3 * force_N, state_->scene.force);
}

void CenterlineSimulation::set_torque(Index node, const Vec3& torque_N_mm) {
  require_finite(torque_N_mm, "a torque");
  state_->load(node, 1e3 * torque_N_mm, state_->scene.torque);
}

void CenterlineSimulation::set_radial_scale(Index node, double scale) {
  if (!(std::isfinite(scale) && scale > 0)) throw InvalidInput("simulation: a radial scale must be finite and above 0");
  state_->profile.set_scale(state_->slot(node), scale, state_->scene);
}

void CenterlineSimulation::set_squeeze(Index node, double force_N) {
  if (!std::isfinite(force_N)) throw InvalidInput("simulation: a squeeze must be finite");
  state_->profile.set_squeeze(state_->slot(node), force_N, state_->scene);
}

void CenterlineSimulation::set_velocity(Index node, const Vec3& velocity_mm_s) {
  require_finite(velocity_mm_s, "a velocity");
  state_->scene.velocity[state_->stir(node)] = velocity_mm_s;
}

void CenterlineSimulation::set_gravity(const Vec3& gravity_mm_s2) {
  require_finite(gravity_mm_s2, "gravity");
  state_->scene.options.gravity_mm_s2 = gravity_mm_s2;
  state_->implicit.wake_all();
}

void CenterlineSimulation::cut(const CenterlineCut& cut) {
  require_cut(state_->scene, cut);
  state_ = std::make_unique<State>(*state_, cut);
}

void CenterlineSimulation::divide(const InsertedNode& node) {
  const CenterlineCut within = uncut(node);
  require_cut(state_->scene, within);
  state_ = std::make_unique<State>(*state_, within);
}

void CenterlineSimulation::set_contact(const ContactOptions& options) { state_->touching.set_contact(options); }

Index CenterlineSimulation::add_instrument(const InstrumentShape& shape, const InstrumentPose& pose) {
  return state_->touching.add_instrument(shape, pose);
}

double CenterlineSimulation::room_for_instrument_mm(const InstrumentShape& shape, const InstrumentPose& pose) const {
  return state_->touching.room_for(shape, pose);
}

void CenterlineSimulation::remove_instrument(Index instrument) { state_->touching.remove_instrument(instrument); }

void CenterlineSimulation::move_instrument(Index instrument, const InstrumentPose& pose) {
  state_->touching.move_instrument(instrument, pose);
}

InstrumentPose CenterlineSimulation::instrument_pose(Index instrument) const {
  return state_->touching.instrument_pose(instrument);
}

Index CenterlineSimulation::grasp(Index segment, double t, double slips_N) {
  return state_->touching.grasp(segment, t, slips_N);
}

void CenterlineSimulation::move_jaw(Index jaw, const Vec3& position_mm) { state_->touching.move_jaw(jaw, position_mm); }

void CenterlineSimulation::open_jaw(Index jaw) { state_->touching.open_jaw(jaw); }

Vec3 CenterlineSimulation::jaw_position(Index jaw) const { return state_->touching.jaw_position(jaw); }

void CenterlineSimulation::set_tissue(Index segment, const TissueProperties& tissue) {
  state_->touching.set_tissue(segment, tissue);
}

std::size_t CenterlineSimulation::torn() const { return state_->touching.torn(); }

HandForce CenterlineSimulation::drag_force(Index node) const { return state_->touching.drag_force(state_->slot(node)); }

HandForce CenterlineSimulation::instrument_force(Index instrument) const {
  return state_->touching.instrument_force(instrument);
}

HandForce CenterlineSimulation::jaw_force(Index jaw) const { return state_->touching.jaw_force(jaw); }

double CenterlineSimulation::contact_energy_J() const { return state_->touching.energy_J(); }

double CenterlineSimulation::smallest_gap_mm() const { return state_->touching.smallest_gap_mm(); }

StepReport CenterlineSimulation::step() noexcept {
  const bool implicit = state_->scene.options.integrator == Integrator::implicit;
  const StepReport report = implicit ? state_->implicit.step(state_->scene) : state_->paper.step(state_->scene);
  state_->profile.step(state_->scene);
  return report;
}

const RodTree& CenterlineSimulation::tree() const { return state_->scene.tree; }

const Pose& CenterlineSimulation::pose() const { return state_->scene.pose; }

Vec3 CenterlineSimulation::position(Index node) const { return state_->scene.pose.position[state_->slot(node)]; }

double CenterlineSimulation::kinetic_energy_J() const { return 1e-6 * kinetic_energy(state_->scene); }

double CenterlineSimulation::elastic_energy_J() const { return 1e-6 * elastic_energy(state_->scene); }

const std::vector<char>& CenterlineSimulation::moved() const { return state_->scene.moved; }

void CenterlineSimulation::clear_moved() { std::fill(state_->scene.moved.begin(), state_->scene.moved.end(), char{0}); }

}  // namespace vmesh
