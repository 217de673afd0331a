// ImplicitRods: velocities, the energy's governor and rest, at the end of a step.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

/// Rounding makes frames that much less orthonormal in so many steps: about 1e-14.
constexpr std::size_t kSharpenEvery = 64;

}  // namespace

void ImplicitRods::finish(RodScene& scene, StepReport& report) {
  const bool sharpens = ++steps_ % kSharpenEvery == 0;
  Balance balance;
  balance.before = start_tie_energy_;
  balance.elastic = tie_energy(scene);
  for (const Index j : visited_slots_) {
    if (sharpens) sharpen(scene.pose.frame[j]);
    set_velocities(scene, j);
    const double given = scene.hold[j] == Hold::free ? 0 : 0.5 * scene.rods[j].mass * scene.velocity[j].squaredNorm();
    balance.work += work(scene, j);
    balance.before += start_kinetic_[j] + start_elastic_[j];
    balance.elastic += elastic_[j];
    balance.held += given;
    balance.free += kinetic_energy(scene, j) - given;
  }
  report.work_J = 1e-6 * govern(scene, balance);
  for (const Index j : visited_slots_) settle(scene, j);
  std::erase_if(awake_slots_, [this](Index j) { return !awake_[j]; });
  report.awake = awake_count_;
}

void ImplicitRods::set_velocities(RodScene& scene, Index j) {
  turn_[j] = turned_by(start_frame_[j], scene.pose.frame[j]);
  scene.velocity[j] = (scene.pose.position[j] - start_position_[j]) / step_s_;
  scene.spin[j] = turn_[j] / step_s_;
}

/// Of forces, gravity and what drags, on slot j, uJ.
double ImplicitRods::work(const RodScene& scene, Index j) const {
  const Rod& rod = scene.rods[j];
  const Vec3 moved = scene.pose.position[j] - start_position_[j];
  const double turning = scene.torque[j].dot(turn_[j]);
  if (scene.hold[j] == Hold::free) {
    return turning + (scene.force[j] + rod.mass * scene.options.gravity_mm_s2).dot(moved);
  }
  if (moved == Vec3::Zero()) return turning;
  Vec3 hand = rod.mass / step_s_ * (scene.velocity[j] - start_velocity_[j]) + equations_[j].spring_gradient.linear;
  for (Index c = rod.first_child; c != kNone; c = scene.rods[c].next_sibling)
    hand -= equations_[c].spring_gradient.linear;
  return turning + hand.dot(moved);
}

/// Scales the velocities of what is free down where there is more energy than there may be: exactly minimised and with
/// convex springs there never is. Returns the work that was done. Where the springs hold more than came in by the
/// forces at the end of the step, as a slot was dragged far in it or the minimum is not reached, that is what it took:
/// at most the energy of having struck and dragged first with all else standing still.
double ImplicitRods::govern(RodScene& scene, const Balance& balance) {
  const auto& [before, work, elastic, free, held] = balance;
  const double allowed = std::max(0.0, std::min(before + work - held, energy_bound_) - elastic);
  if (free > allowed) {
    const double factor = std::sqrt(allowed / free);
    for (const Index j : visited_slots_) {
      if (scene.hold[j] == Hold::free) scene.velocity[j] *= factor;
      scene.spin[j] *= factor;
    }
  }
  return std::max(work, elastic + held - before);
}

/// Counts quiet steps; brings slot j to rest after enough, and leaves it alone after a step more, which has seen it so.
void ImplicitRods::settle(RodScene& scene, Index j) {
  const Vec3 moved = scene.pose.position[j] - start_position_[j];
  if (moved != Vec3::Zero() || turn_[j] != Vec3::Zero()) scene.moved[j] = 1;
  if (!awake_[j]) return;
  const double tolerance = scene.options.rest_tolerance;
  const bool quiet = moved.norm() <= tolerance * scene.rods[j].radius && turn_[j].norm() <= tolerance;
  const char enough = static_cast<char>(scene.options.rest_steps);
  quiet_steps_[j] = quiet && tolerance > 0 ? static_cast<char>(quiet_steps_[j] + 1) : char{0};
  if (quiet_steps_[j] == enough) {
    scene.velocity[j].setZero();
    scene.spin[j].setZero();
  } else if (quiet_steps_[j] > enough) {
    awake_[j] = 0;
    --awake_count_;
  }
}

}  // namespace vmesh
