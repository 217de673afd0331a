#pragma once

#include "deform/rod_batch.h"

namespace vmesh {

/// Sums over slots, one per lane.
struct BeginSums {
  Lanes value{};   ///< objective: inertia and springs, uJ
  Lanes energy{};  ///< kinetic and elastic, uJ
};
struct MoveSums {
  Lanes value{};    ///< objective: inertia, springs and damping, uJ
  Lanes largest{};  ///< squared displacement, mm^2
};
struct FinishSums {
  Lanes work{}, elastic{};
  Lanes free{}, held{};  ///< kinetic energy of free and of held slots
};

/// A move from one pose to another by a fraction of the solution. If chained, segments rotate with their frames and
/// their subtrees follow; otherwise nodes move straight. Held slots go the full distance.
struct RodMove {
  std::size_t from = 0, to = 1;  ///< of RodBatch::pose
  double part = 1;
  bool chained = true;
};

/// The operations on a batch of slots in a step of ImplicitRods. `active`, by lane, says for which slots; the others
/// stay unchanged.
struct RodKernels {
  /// Reads the scene; predicts, and evaluates inertia.
  void (*begin)(RodBatch& batch, const char* active, const RodScene& scene, BeginSums& sums);
  /// Eliminates slots whose children have been eliminated: computes `reduced`, or x for a root.
  void (*eliminate)(RodBatch* batches, Index batch, const std::array<Index, kLanes>* children, std::size_t pose,
                    const char* active);
  /// Computes x from the parent's. Zero for lanes in `rests` where it is within the tolerance, and where it is not
  /// finite: a result spoilt by overflow is not a solution, and standing still is always allowed.
  void (*substitute)(RodBatch* batches, Index batch, std::size_t pose, const char* active, const char* rests,
                     double tolerance);
  /// Moves and evaluates.
  void (*move)(RodBatch* batches, Index batch, const char* active, const RodMove& by, MoveSums& sums);
  /// Writes velocities and energies at the end of a step to the scene; `quiet`, by lane: hardly moved. Pose number
  /// `pose` becomes the starting pose.
  void (*finish)(RodBatch* batches, Index batch, const std::array<Index, kLanes>* children, const char* active,
                 std::size_t pose, bool sharpens, RodScene& scene, char* quiet, FinishSums& sums);
};

/// All do the same operations in the same order, so the results are the same to the bit. Null where the machine or the
/// compiler does not support them.
const RodKernels* plain_rod_kernels();
const RodKernels* avx2_rod_kernels();
/// The fastest available kernels.
const RodKernels& best_rod_kernels();

}  // namespace vmesh
