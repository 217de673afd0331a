// ImplicitRods: the solution of one Gauss-Newton iteration on the tree, and with the springs that close loops.
#include <algorithm>
#include <cmath>

#include "deform/implicit_rods.h"

namespace vmesh {
namespace {

/// Loops are closed to this fraction of how far they would open without their springs.
constexpr double kTieTolerance = 1e-6;
constexpr int kMostTieIterations = 60;

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

void add(std::vector<Vec3>& a, double factor, const std::vector<Vec3>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += factor * b[i];
}

}  // namespace

void ImplicitRods::solve(const RodScene& scene) {
  if (scene.tree.ties.empty())
    solve_tree(scene);
  else
    solve_ties(scene);
}

void ImplicitRods::solve_tree(const RodScene& scene) {
  for (std::size_t i = visited_slots_.size(); i-- > 0;) {
    if (i >= kAhead) fetch(equations_[visited_slots_[i - kAhead]]);
    eliminate(equations_, scene.rods, visited_slots_[i]);
  }
  substitute_all(scene);
}

/// The list grows while it is gone through: what moves wakes its children.
void ImplicitRods::substitute_all(const RodScene& scene) {
  const std::size_t before = visited_slots_.size();
  for (std::size_t i = 0; i < visited_slots_.size(); ++i) {
    const Index j = visited_slots_[i];
    fetch_ahead(scene, i);
    if (i >= before) begin(scene, j);
    solve_slot(scene, j);
    if (equations_[j].x.linear != Vec3::Zero() || equations_[j].x.angular != Vec3::Zero()) visit_children(scene, j);
  }
  if (visited_slots_.size() > before) std::sort(visited_slots_.begin(), visited_slots_.end());
}

void ImplicitRods::solve_slot(const RodScene& scene, Index j) {
  if (!scene.is_root(j)) substitute(equations_, j, scene.rods[j].parent);
  // What rounding spoilt at the ends of the range of numbers is no solution: standing still is always allowed.
  const Spatial& x = equations_[j].x;
  if (stays(scene, j) || !x.linear.allFinite() || !x.angular.allFinite())
    equations_[j].x = {};
  else if (!awake_[j])
    wake(j);
  set_base(scene, j);
}

/// Whether slot j is at rest and remains so.
bool ImplicitRods::stays(const RodScene& scene, Index j) const {
  if (awake_[j] && quiet_steps_[j] < scene.options.rest_steps) return false;
  const double tolerance = scene.options.rest_tolerance;
  return equations_[j].x.linear.norm() <= tolerance * scene.rods[j].radius &&
         equations_[j].x.angular.norm() <= tolerance;
}

/// What x opens the ties by, with `load` pulling on them.
void ImplicitRods::solve_loaded(const RodScene& scene, const std::vector<Vec3>& load, std::vector<Vec3>& opening) {
  const auto& ties = scene.tree.ties;
  const auto pull = [&](double sign) {
    for (std::size_t i = 0; i < ties.size(); ++i) {
      equations_[ties[i].slot].gradient.linear += sign * load[i];
      equations_[ties[i].node_slot].gradient.linear -= sign * load[i];
    }
  };
  pull(1);
  solve_tree(scene);
  pull(-1);
  for (std::size_t i = 0; i < ties.size(); ++i)
    opening[i] = equations_[ties[i].slot].x.linear - equations_[ties[i].node_slot].x.linear;
}

/// The forces F in the ties follow from F / k = gap + opening(F), by conjugate gradients: opening() is linear in F but
/// for a constant, and as many equations as there are loops.
void ImplicitRods::solve_ties(const RodScene& scene) {
  const auto& ties = scene.tree.ties;
  for (Vec3& f : tie_load_) f.setZero();
  solve_loaded(scene, tie_load_, tie_opening_);
  for (std::size_t i = 0; i < ties.size(); ++i)
    tie_residual_[i] = scene.pose.position[ties[i].slot] - scene.pose.position[ties[i].node_slot] + tie_opening_[i];
  tie_direction_ = tie_residual_;
  double norm = dot(tie_residual_, tie_residual_);
  const double enough = kTieTolerance * kTieTolerance * norm;
  for (int i = 0; i < kMostTieIterations && norm > enough; ++i) {
    solve_loaded(scene, tie_direction_, tie_image_);
    for (std::size_t t = 0; t < ties.size(); ++t)
      tie_image_[t] = tie_opening_[t] - tie_image_[t] + tie_direction_[t] / scene.tie_stretch;
    const double step = norm / dot(tie_direction_, tie_image_);
    add(tie_load_, step, tie_direction_);
    add(tie_residual_, -step, tie_image_);
    const double next = dot(tie_residual_, tie_residual_);
    for (std::size_t t = 0; t < ties.size(); ++t)
      tie_direction_[t] = tie_residual_[t] + next / norm * tie_direction_[t];
    norm = next;
  }
  solve_loaded(scene, tie_load_, tie_image_);
}

}  // namespace vmesh
