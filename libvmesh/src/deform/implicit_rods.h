#pragma once

#include <vector>

#include "deform/rod_equations.h"
#include "deform/rod_scene.h"

namespace vmesh {

/// Implicit Euler on the energy of the springs: every step minimises
///   sum m / (2 h^2) |p - p_predicted|^2 + elastic energy + damping,
/// the same with the tips of the x and y axes for the frames, by Gauss-Newton and what tension adds to it. Each
/// iteration is one exact solution on the tree, O(n). Iterates that would raise the sum are halved, so it never exceeds
/// what standing still has; after that velocities are scaled down where kinetic and elastic energy exceed what was
/// there and the work done. Only slots that move are visited, those next to them and those towards the root.
class ImplicitRods {
 public:
  explicit ImplicitRods(const RodScene& scene);

  void wake(Index slot);
  void wake_all();
  StepReport step(RodScene& scene) noexcept;

 private:
  /// Energies of a step, uJ.
  struct Balance {
    double before = 0, work = 0, elastic = 0;
    double free = 0, held = 0;  ///< kinetic, of what moves by itself and of what is moved
  };

  void choose_visited(const RodScene& scene);
  void visit(Index j);
  void visit_children(const RodScene& scene, Index j);
  void begin(const RodScene& scene, Index j);
  double evaluate(const RodScene& scene, Index j);
  double evaluate_inertia(const RodScene& scene, Index j);
  double evaluate_springs(const RodScene& scene, Index j);
  double evaluate_damping(const RodScene& scene, Index j);

  /// Slots between what is worked on and what is asked for.
  static constexpr std::size_t kAhead = 4;
  void fetch_ahead(const RodScene& scene, std::size_t i) const;

  void solve(const RodScene& scene);
  void solve_tree(const RodScene& scene);
  void solve_ties(const RodScene& scene);
  void solve_loaded(const RodScene& scene, const std::vector<Vec3>& load, std::vector<Vec3>& opening);
  void substitute_all(const RodScene& scene);
  void solve_slot(const RodScene& scene, Index j);
  bool stays(const RodScene& scene, Index j) const;

  bool dragged(const RodScene& scene, Index j) const;
  double iterate(RodScene& scene, bool first, StepReport& report);
  void set_base(const RodScene& scene, Index j);
  void drag(RodScene& scene);
  double move(RodScene& scene, double part, bool chained);

  void finish(RodScene& scene, StepReport& report);
  void set_velocities(RodScene& scene, Index j);
  double work(const RodScene& scene, Index j) const;
  double govern(RodScene& scene, const Balance& balance);
  void settle(RodScene& scene, Index j);

  double step_s_;
  std::vector<RodEquation> equations_;
  std::vector<char> visited_, awake_, quiet_steps_;
  std::vector<Index> visited_slots_, awake_slots_;  // those in visited_, ascending, and in awake_
  std::size_t awake_count_ = 0;

  std::vector<Vec3> start_position_, start_velocity_, base_position_, predicted_position_, predicted_x_, predicted_y_;
  std::vector<Mat3> start_frame_, base_frame_;
  std::vector<Vec3> turn_, base_turn_;  // since the step's start: sum of the iterations' rotation vectors
  std::vector<Vec3> start_misfit_, base_misfit_, misfit_change_;
  std::size_t steps_ = 0;
  std::vector<double> elastic_, start_elastic_, start_kinetic_;
  double value_ = 0;         // the sum to minimise but for the ties, where things are
  double energy_bound_ = 0;  // of the step: what standing still has
  bool drags_ = false;       // in this step
  double start_tie_energy_ = 0;

  std::vector<Vec3> tie_load_, tie_residual_, tie_direction_, tie_image_, tie_opening_;
};

}  // namespace vmesh
