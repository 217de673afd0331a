#include "deform/paper_rods.h"

#include <algorithm>
#include <cmath>

#include "deform/spatial.h"

namespace vmesh {
namespace {

using Procedure = PaperProcedure;

/// Step as a share of the time in which the fastest oscillation advances by one radian: half the limit at which springs
/// damped as below become unstable.
constexpr double kSafeStep = 0.5;
/// Largest damping that explicit springs tolerate, in multiples of that duration.
constexpr double kMostDamping = 1;

/// Bound on the highest oscillation rate of a node or tip between its springs, rad/s: from twice the sum of their
/// stiffnesses.
double fastest_rate(const RodScene& scene) {
  std::vector<double> node(scene.size(), 0), tip(scene.size(), 0);
  for (Index j = 0; j < scene.size(); ++j) {
    const Rod& rod = scene.rods[j];
    if (rod.parent == kNone) continue;
    const double angular = std::max(rod.tip_xy, rod.tip_z);
    node[j] += rod.stretch;
    node[rod.parent] += rod.stretch;
    tip[j] += angular + rod.stretch * rod.length * rod.length;
    tip[rod.parent] += angular;
  }
  double fastest2 = 0;
  for (Index j = 0; j < scene.size(); ++j)
    fastest2 = std::max({fastest2, 2 * node[j] / scene.rods[j].mass, 2 * tip[j] / scene.rods[j].inertia});
  return std::sqrt(fastest2);
}

int substeps_of(const RodScene& scene) {
  if (scene.options.paper.substeps > 0) return scene.options.paper.substeps;
  const double needed = std::ceil(scene.options.step_s * fastest_rate(scene) / kSafeStep);
  return static_cast<int>(std::clamp(needed, 1.0, 1e9));
}

Mat3 polar(Mat3 axes) {
  for (int i = 0; i < 4; ++i) sharpen(axes);
  return axes;
}

Mat3 normalized(Mat3 axes) {
  for (int i = 0; i < 3; ++i) axes.col(i).normalize();
  return axes;
}

/// Eqs. 6 and 7.
Mat3 keeping_z(const Mat3& axes) {
  Mat3 frame;
  frame.col(2) = axes.col(2);
  frame.col(1) = axes.col(2).cross(axes.col(0)).normalized();
  frame.col(0) = frame.col(1).cross(frame.col(2));
  return frame;
}

}  // namespace

PaperRods::PaperRods(const RodScene& scene)
    : substeps_(substeps_of(scene)),
      dt_s_(scene.options.step_s / substeps_),
      force_(scene.size()),
      start_(scene.size()),
      tip_force_(scene.size()),
      tip_velocity_(scene.size(), Mat3::Zero()) {}

StepReport PaperRods::step(RodScene& scene) noexcept {
  StepReport report;
  report.awake = scene.size();
  for (; report.iterations < substeps_; ++report.iterations) {
    add_forces(scene);
    report.work_J += 1e-6 * move(scene);
  }
  std::fill(scene.moved.begin(), scene.moved.end(), char{1});
  return report;
}

void PaperRods::carry_on(const PaperRods& before, const RodScene& old, const RodScene& scene,
                         const std::vector<SlotOrigin>& origin) {
  for (Index j = 0; j < scene.size(); ++j) {
    const Index from = origin[j].frame;
    tip_velocity_[j] = before.tip_velocity_[from] * old.tree.frame[from].transpose() * scene.tree.frame[j];
  }
}

void PaperRods::add_forces(const RodScene& scene) {
  for (Index j = 0; j < scene.size(); ++j) {
    const Rod& rod = scene.rods[j];
    const Mat3& frame = scene.pose.frame[j];
    force_[j] = scene.force[j] + rod.mass * scene.options.gravity_mm_s2;
    const Vec3 torque = scene.torque[j], z = frame.col(2);
    tip_force_[j] = cross_columns(torque - 0.5 * z.dot(torque) * z, frame);
    tip_force_[j].col(2).setZero();
  }
  for (Index j = 0; j < scene.size(); ++j) {
    if (scene.is_root(j)) continue;
    add_spring(scene, j);
    add_angular_springs(scene, j);
  }
}

void PaperRods::add_spring(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  const double damping = std::min(rod.damping_s, kMostDamping * dt_s_);
  const Vec3 between = scene.pose.position[j] - scene.pose.position[rod.parent];
  Vec3 pull;
  if (scene.options.paper.coupling == Procedure::Coupling::spring) {
    pull = rod.stretch * misfit(scene, j);
    tip_force_[j].col(2) += rod.length * pull;
  } else {
    const double length = between.norm();
    if (length == 0) return;
    const double rate = between.dot(scene.velocity[j] - scene.velocity[rod.parent]) / length;
    pull = rod.stretch * (length - rod.length + damping * rate) / length * between;
  }
  force_[j] -= pull;
  force_[rod.parent] += pull;
}

/// Springs of zero rest length between the tips of the parent's rotated axes and the slot's own (Fig. 3, B and C).
void PaperRods::add_angular_springs(const RodScene& scene, Index j) {
  const Rod& rod = scene.rods[j];
  const double damping = std::min(rod.damping_s, kMostDamping * dt_s_);
  const Mat3 apart = scene.pose.frame[rod.parent] * rod.turn - scene.pose.frame[j];
  const Mat3 parting = tip_velocity_[rod.parent] * rod.turn - tip_velocity_[j];
  const Vec3 stiffness(rod.tip_xy, rod.tip_xy, rod.tip_z);
  const Mat3 pull = (apart + damping * parting) * stiffness.asDiagonal();
  tip_force_[j] += pull;
  tip_force_[rod.parent] -= pull * rod.turn.transpose();
}

/// Returns the work done, uJ.
double PaperRods::move(RodScene& scene) {
  const double kept = 1 / (1 + scene.options.drag_per_s * dt_s_);
  double work = 0;
  for (Index j = 0; j < scene.size(); ++j) {
    const Rod& rod = scene.rods[j];
    Vec3& p = scene.pose.position[j];
    start_[j] = p;
    scene.velocity[j] = kept * (scene.velocity[j] + dt_s_ / rod.mass * force_[j]);
    if (scene.hold[j] == Hold::free) {
      p += dt_s_ * scene.velocity[j];
    } else {
      p += (scene.target[j] - p) * std::min(1.0, 1.0 / substeps_);
      scene.velocity[j] = (p - start_[j]) / dt_s_;
    }
    const Mat3 before = scene.pose.frame[j];
    tip_velocity_[j] = kept * (tip_velocity_[j] + dt_s_ / rod.inertia * tip_force_[j]);
    if (scene.hold[j] != Hold::clamped) {
      scene.pose.frame[j] += dt_s_ * tip_velocity_[j];
      align(scene, j);
    }
    tip_velocity_[j] = (scene.pose.frame[j] - before) / dt_s_;
    scene.spin[j] = turned_by(before, scene.pose.frame[j]) / dt_s_;
    if (scene.options.paper.coupling == Procedure::Coupling::printed) scene.velocity[j] = (p - start_[j]) / dt_s_;
    work += (scene.force[j] + rod.mass * scene.options.gravity_mm_s2).dot(p - start_[j]);
  }
  return work;
}

/// Eqs. 4 to 8 for slot j, whose parent is done.
void PaperRods::align(RodScene& scene, Index j) const {
  const Procedure& procedure = scene.options.paper;
  Mat3 axes = normalized(scene.pose.frame[j]);
  const bool printed = procedure.coupling == Procedure::Coupling::printed && !scene.is_root(j);
  Vec3& p = scene.pose.position[j];
  double length = 0;
  if (printed) {
    const Vec3 along = p - scene.pose.position[scene.rods[j].parent];
    length = along.norm();
    if (length > 0) axes.col(2) = (along / length + axes.col(2)).normalized();
  }
  axes = procedure.axes == Procedure::Axes::polar ? polar(axes) : keeping_z(axes);
  if (printed && scene.hold[j] == Hold::free) p = scene.pose.position[scene.rods[j].parent] + length * axes.col(2);
  scene.pose.frame[j] = axes;
}

}  // namespace vmesh
