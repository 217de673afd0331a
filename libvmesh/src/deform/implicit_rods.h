#pragma once

#include <vector>

#include "deform/rod_batch.h"
#include "deform/rod_kernels.h"
#include "deform/rod_scene.h"

namespace vmesh {

inline double sum(const Lanes& lanes) {
  double total = 0;
  for (std::size_t i = 0; i < kLanes; ++i) total += lanes[i];
  return total;
}

/// Implicit Euler on the energy of the springs: every step minimises
///   sum m / (2 h^2) |p - p_predicted|^2 + elastic energy + damping,
/// the same with the tips of the x and y axes for the frames, by Gauss-Newton plus the geometric stiffness of tension.
/// Each iteration is one exact solution on the tree, O(n), four slots of one height at a time. Updates that would raise
/// the sum are halved, so it never exceeds its value for standing still; afterwards, velocities are scaled down where
/// kinetic and elastic energy exceed the previous energy plus the work done. Only moving slots, those next to them and
/// those towards the root are visited.
class ImplicitRods {
 public:
  explicit ImplicitRods(const RodScene& scene, InstructionSet set = best_instruction_set());

  void wake(Index slot);
  void wake_all();
  StepReport step(RodScene& scene) noexcept;

 private:
  using FourFlags = std::array<char, kLanes>;

  void wake_place(Index place);
  void choose_visited();
  void visit(Index place);
  void visit_children(Index place);
  template <class Visit>
  void for_children(Index place, Visit visit) const {
    const RodBatch& b = batches_.batches[place / kLanes];
    for (Index rank = 0; rank < b.child_ranks; ++rank) {
      const Index child = batches_.children[b.first_children + rank][place % kLanes];
      if (child < visited_.size()) visit(child);
    }
  }
  void note_pulled(Index batch);

  double iterate(RodScene& scene, bool first, StepReport& report);
  /// `then`: the move to make once the solution is known; null: none.
  void solve(const RodScene& scene, const RodMove* then);
  void eliminate(Index batch);
  void solve_tree(const RodScene& scene, const RodMove* then);
  void solve_growing(const RodScene& scene, const RodMove* then);
  void solve_ties(const RodScene& scene, const RodMove* then);
  void solve_loaded(const RodScene& scene, const std::vector<Vec3>& load, std::vector<Vec3>& opening,
                    const RodMove* then);
  void solve_batch(const RodScene& scene, Index batch, const RodMove* then);
  FourFlags resting(const RodScene& scene, Index batch) const;
  void wake_children(Index batch);
  void move(const RodMove& by);

  Vec3 position(Index place, std::size_t pose) const;
  Vec3 pull(Index place) const;
  double drag_energy() const;
  double tie_energy(const RodScene& scene, bool pulled) const;

  void finish(RodScene& scene, StepReport& report);
  double govern(RodScene& scene, const FinishSums& sums) const;
  void settle(RodScene& scene, Index place, bool quiet);

  const RodKernels* kernels_;
  RodBatches batches_;
  std::vector<char> visited_, fresh_, awake_, quiet_steps_;  // by place
  std::vector<char> listed_;                                 // by batch: in one of the following
  std::vector<Index> visited_batches_, grown_batches_;       // ascending; a heap
  std::vector<Index> awake_places_, pulled_places_;
  std::size_t awake_count_ = 0, slot_count_ = 0;
  bool all_visited_ = false;
  bool eliminated_ = false;  // all visited slots, in their present state

  std::size_t pose_ = 0;  // index of the current pose
  BeginSums begin_sums_;
  MoveSums move_sums_;
  double energy_bound_ = 0;  // of the step: the value for standing still
  double start_tie_energy_ = 0;
  std::size_t steps_ = 0;

  std::vector<Vec3> tie_load_, tie_residual_, tie_direction_, tie_image_, tie_opening_;
};

}  // namespace vmesh
