#include "deform/implicit_rods.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

/// Rounding of a sum of the terms of the energy.
constexpr double kEnergyTolerance = 1e-12;
constexpr int kMostAttempts = 40;
/// With more than one in so many slots awake, looking at all of them is faster than sorting.
constexpr std::size_t kMuchAwake = 8;
/// Strain up to which tension counts in full: beyond, its stiffness would drown that of the springs in rounding.
constexpr double kMostTautness = 10;

}  // namespace

ImplicitRods::ImplicitRods(const RodScene& scene) : step_s_(scene.options.step_s) {
  const std::size_t n = scene.size();
  equations_.resize(n);
  for (Index j = 0; j < n; ++j) {
    const Rod& rod = scene.rods[j];
    RodEquation& e = equations_[j];
    const double drag = 1 + scene.options.drag_per_s * step_s_, damping = 1 + rod.damping_s / step_s_;
    e.mass = drag * rod.mass / (step_s_ * step_s_);
    e.inertia = drag * rod.inertia / (step_s_ * step_s_);
    if (rod.parent == kNone) continue;
    e.stretch = rod.stretch * damping;
    e.bend = (rod.tip_xy + rod.tip_z) * damping;
    e.twist = 2 * rod.tip_xy * damping;
    e.stretch_compliance = 1 / e.stretch;
    e.bend_compliance = 1 / e.bend;
    e.twist_compliance = 1 / e.twist;
  }
  start_position_ = start_velocity_ = base_position_ = predicted_position_ = scene.pose.position;
  predicted_x_ = predicted_y_ = turn_ = base_turn_ = start_misfit_ = predicted_position_;
  base_misfit_ = misfit_change_ = predicted_position_;
  start_frame_ = base_frame_ = scene.pose.frame;
  elastic_.assign(n, 0);
  start_elastic_ = start_kinetic_ = elastic_;
  visited_.assign(n, 0);
  visited_slots_.reserve(n);
  awake_slots_.reserve(n);
  awake_ = quiet_steps_ = visited_;
  tie_load_.resize(scene.tree.ties.size());
  tie_residual_ = tie_direction_ = tie_image_ = tie_opening_ = tie_load_;
  for (Index j = 0; j < n; ++j)
    if (!scene.is_root(j)) elastic_[j] = evaluate_springs(scene, j);
  wake_all();
}

void ImplicitRods::wake(Index slot) {
  if (!awake_[slot]) awake_slots_.push_back(slot);
  awake_count_ += !awake_[slot];
  awake_[slot] = 1;
  quiet_steps_[slot] = 0;
}

void ImplicitRods::wake_all() {
  for (Index j = 0; j < awake_.size(); ++j) wake(j);
}

StepReport ImplicitRods::step(RodScene& scene) noexcept {
  StepReport report;
  if (awake_count_ == 0) return report;
  if (!scene.tree.ties.empty() && awake_count_ < awake_.size()) wake_all();
  choose_visited(scene);
  value_ = 0;
  drags_ = false;
  for (const Index j : visited_slots_) begin(scene, j);
  start_tie_energy_ = tie_energy(scene);
  for (int i = 0; i < scene.options.iterations; ++i) {
    report.movement_mm = iterate(scene, i == 0, report);
    ++report.iterations;
    if (report.movement_mm == 0) break;
  }
  finish(scene, report);
  return report;
}

/// What is awake, its children, and all on the way to the root, in ascending order.
void ImplicitRods::choose_visited(const RodScene& scene) {
  for (const Index j : visited_slots_) visited_[j] = 0;
  visited_slots_.clear();
  if (kMuchAwake * awake_count_ > scene.size()) {
    for (Index j = static_cast<Index>(scene.size()); j-- > 0;) {
      const Index parent = scene.tree.parent[j];
      if (awake_[j] || (parent != kNone && awake_[parent])) visited_[j] = 1;
      if (visited_[j] && parent != kNone) visited_[parent] = 1;
    }
    for (Index j = 0; j < scene.size(); ++j)
      if (visited_[j]) visited_slots_.push_back(j);
    return;
  }
  for (const Index j : awake_slots_) {
    for (Index up = j; up != kNone && !visited_[up]; up = scene.tree.parent[up]) visit(up);
    visit_children(scene, j);
  }
  std::sort(visited_slots_.begin(), visited_slots_.end());
}

void ImplicitRods::visit(Index j) {
  visited_[j] = 1;
  visited_slots_.push_back(j);
}

void ImplicitRods::visit_children(const RodScene& scene, Index j) {
  for (Index c = scene.rods[j].first_child; c != kNone; c = scene.rods[c].next_sibling)
    if (!visited_[c]) visit(c);
}

void ImplicitRods::begin(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  const Vec3& p = scene.pose.position[j];
  const Mat3& frame = scene.pose.frame[j];
  start_position_[j] = p;
  start_frame_[j] = frame;
  start_velocity_[j] = scene.velocity[j];
  start_elastic_[j] = elastic_[j];
  start_kinetic_[j] = kinetic_energy(scene, j);
  turn_[j] = Vec3::Zero();
  start_misfit_[j] = equations_[j].elastic_gradient.linear * (scene.is_root(j) ? 0 : 1 / rod.stretch);

  const double reach = step_s_ / (1 + scene.options.drag_per_s * step_s_);
  const Vec3 z = frame.col(2), torque = scene.torque[j];
  const Vec3 velocity = scene.velocity[j] + step_s_ * (scene.options.gravity_mm_s2 + scene.force[j] / rod.mass);
  const Vec3 spin = scene.spin[j] + step_s_ / rod.inertia * (torque - 0.5 * z.dot(torque) * z);
  predicted_position_[j] = p + reach * velocity;
  predicted_x_[j] = frame.col(0) + reach * spin.cross(Vec3(frame.col(0)));
  predicted_y_[j] = frame.col(1) + reach * spin.cross(Vec3(frame.col(1)));
  equations_[j].spring_gradient = equations_[j].elastic_gradient;
  value_ += evaluate_inertia(scene, j) + elastic_[j];
  drags_ = drags_ || dragged(scene, j);
}

double ImplicitRods::evaluate(const RodScene& scene, Index j) {
  const double inertia = evaluate_inertia(scene, j);
  if (scene.is_root(j)) return inertia;
  elastic_[j] = evaluate_springs(scene, j);
  return inertia + elastic_[j] + evaluate_damping(scene, j);
}

double ImplicitRods::evaluate_inertia(const RodScene& scene, Index j) {
  RodEquation& e = equations_[j];
  const Mat3& frame = scene.pose.frame[j];
  const Vec3 x = frame.col(0), y = frame.col(1);
  e.z = frame.col(2);
  e.lever = scene.rods[j].length * e.z;
  e.hold = scene.hold[j];
  e.prescribed = e.hold == Hold::free ? Vec3(Vec3::Zero()) : Vec3(scene.target[j] - scene.pose.position[j]);
  const Vec3 off = scene.pose.position[j] - predicted_position_[j];
  e.gradient.linear = e.mass * off;
  e.gradient.angular = -e.inertia * (x.cross(predicted_x_[j]) + y.cross(predicted_y_[j]));
  // A held slot goes where it is told: its inertia is no part of the sum to minimise.
  const double linear = e.hold == Hold::free ? e.mass * off.squaredNorm() : 0;
  return 0.5 * (linear + e.inertia * ((x - predicted_x_[j]).squaredNorm() + (y - predicted_y_[j]).squaredNorm()));
}

double ImplicitRods::evaluate_springs(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  const Mat3& own = scene.pose.frame[j];
  const Mat3 wanted = product(scene.pose.frame[rod.parent], rod.turn);
  const Vec3 stretch = misfit(scene, j);
  const Vec3 x = own.col(0), y = own.col(1), z = own.col(2);
  Spatial& gradient = equations_[j].elastic_gradient;
  gradient.linear = rod.stretch * stretch;
  equations_[j].taut = rod.length * rod.stretch * std::clamp(stretch.dot(z), 0.0, kMostTautness * rod.length);
  gradient.angular = -rod.tip_xy * (x.cross(Vec3(wanted.col(0))) + y.cross(Vec3(wanted.col(1)))) -
                     rod.tip_z * z.cross(Vec3(wanted.col(2)));
  const Mat3 apart = wanted - own;
  return 0.5 *
         (rod.stretch * stretch.squaredNorm() + rod.tip_xy * (apart.col(0).squaredNorm() + apart.col(1).squaredNorm()) +
          rod.tip_z * apart.col(2).squaredNorm());
}

/// Springs are damped against stretch and against turning with respect to the parent since the step's start, not
/// against turning as a whole.
double ImplicitRods::evaluate_damping(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  RodEquation& e = equations_[j];
  e.spring_gradient = e.elastic_gradient;
  if (rod.damping_s == 0) return 0;
  const double rate = rod.damping_s / step_s_;
  const Vec3 stretched = misfit(scene, j) - start_misfit_[j], pull = rate * rod.stretch * stretched;
  const Vec3 z = start_frame_[j].col(2), turn = turn_[j] - turn_[rod.parent];
  const Vec3 torque = rate * ((rod.tip_xy + rod.tip_z) * turn + (rod.tip_xy - rod.tip_z) * z.dot(turn) * z);
  e.spring_gradient.linear += pull;
  e.spring_gradient.angular += torque;
  return 0.5 * (pull.dot(stretched) + turn.dot(torque));
}

bool ImplicitRods::dragged(const RodScene& scene, Index j) const {
  return scene.hold[j] != Hold::free && scene.target[j] != scene.pose.position[j];
}

/// Asks for what will be worked on soon after visited_slots_[i]: in large trees it comes from far.
void ImplicitRods::fetch_ahead(const RodScene& scene, std::size_t i) const {
  if (i + kAhead >= visited_slots_.size()) return;
  const Index j = visited_slots_[i + kAhead];
  fetch(equations_[j]);
  fetch(scene.rods[j]);
  fetch(scene.pose.frame[j]);
  fetch(base_frame_[j]);
}

/// One Gauss-Newton iteration. Returns the largest displacement.
double ImplicitRods::iterate(RodScene& scene, bool first, StepReport& report) {
  solve(scene);
  if (first && drags_) drag(scene);
  const double before = value_ + tie_energy(scene);
  if (first) energy_bound_ = before;
  double part = 1, largest = 0;
  for (int attempt = 0;; ++attempt) {
    if (attempt == kMostAttempts) part = 0;
    const bool chained = attempt % 2 == 0;
    largest = move(scene, part, chained);
    if (part == 0 || value_ + tie_energy(scene) <= before * (1 + kEnergyTolerance)) break;
    if (!chained) part /= 2;
    ++report.rejections;
  }
  return part * largest;
}

/// From where slot j moves, and where the solution would have its segment against its axis if turning by an angle did
/// not lengthen it.
void ImplicitRods::set_base(const RodScene& scene, Index j) {
  base_position_[j] = scene.pose.position[j];
  base_frame_[j] = scene.pose.frame[j];
  base_turn_[j] = turn_[j];
  if (scene.is_root(j)) return;
  const RodEquation& e = equations_[j];
  base_misfit_[j] = e.elastic_gradient.linear / scene.rods[j].stretch;
  misfit_change_[j] = e.x.linear + e.lever.cross(e.x.angular) - equations_[scene.rods[j].parent].x.linear;
}

/// Puts dragged slots where they go, all else standing still.
void ImplicitRods::drag(RodScene& scene) {
  for (const Index j : visited_slots_) {
    const Index parent = scene.rods[j].parent;
    const bool pulled = scene.hold[j] != Hold::free && scene.target[j] != base_position_[j];
    const bool parent_pulled =
        parent != kNone && scene.hold[parent] != Hold::free && scene.target[parent] != base_position_[parent];
    if (!pulled && !parent_pulled) continue;
    value_ -= evaluate_inertia(scene, j) + elastic_[j];
    if (pulled) scene.pose.position[j] = scene.target[j];
    value_ += evaluate(scene, j);
  }
}

/// From the base by a part of the solution; held slots go all the way. Chained, segments turn with their frames, and
/// what hangs on them follows; otherwise nodes move straight. Returns the solution's largest displacement.
double ImplicitRods::move(RodScene& scene, double part, bool chained) {
  value_ = 0;
  double largest = 0;
  for (std::size_t i = 0; i < visited_slots_.size(); ++i) {
    const Index j = visited_slots_[i];
    fetch_ahead(scene, i);
    const Rod& rod = scene.rods[j];
    const Spatial& x = equations_[j].x;
    largest = std::max(largest, x.linear.squaredNorm());
    if (scene.hold[j] != Hold::clamped) {
      scene.pose.frame[j] = product(cayley(part * x.angular), base_frame_[j]);
      turn_[j] = base_turn_[j] + part * x.angular;
    }
    Vec3& p = scene.pose.position[j];
    if (scene.hold[j] != Hold::free) {
      p = scene.target[j];
    } else if (chained && rod.parent != kNone && x.linear != Vec3::Zero()) {
      p = scene.pose.position[rod.parent] + rod.length * scene.pose.frame[j].col(2) + base_misfit_[j] +
          part * misfit_change_[j];
    } else {
      p = base_position_[j] + part * x.linear;
    }
    value_ += evaluate(scene, j);
  }
  return std::sqrt(largest);
}

}  // namespace vmesh
