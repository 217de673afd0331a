#pragma once

#include "deform/rod_batch.h"

namespace vmesh {

/// Sums over slots, one per lane.
struct BeginSums {
  Lanes value{};   ///< to minimise: inertia and springs, uJ
  Lanes energy{};  ///< kinetic and elastic, uJ
};
struct MoveSums {
  Lanes value{};    ///< to minimise: inertia, springs and damping, uJ
  Lanes largest{};  ///< squared displacement, mm^2
};
struct FinishSums {
  Lanes work{}, elastic{};
  Lanes free{}, held{};  ///< kinetic, of what moves by itself and of what is moved
};

/// From one pose to another by a part of the solution. Chained, segments turn with their frames, and what hangs on them
/// follows; otherwise nodes move straight. Held slots go all the way.
struct RodMove {
  std::size_t from = 0, to = 1;  ///< of RodBatch::pose
  double part = 1;
  bool chained = true;
};

/// What is done to a batch of slots in a step of ImplicitRods. `active`, by lane, says for which slots; the others keep
/// what they have.
struct RodKernels {
  /// Reads the scene; predicts, and evaluates inertia.
  void (*begin)(RodBatch& batch, const char* active, const RodScene& scene, BeginSums& sums);
  /// Eliminates slots whose children are: computes `reduced`, or for a root x.
  void (*eliminate)(RodBatch* batches, Index batch, const std::array<Index, kLanes>* children, std::size_t pose,
                    const char* active);
  /// x from the parent's. Nothing for lanes in `rests` where it is within the tolerance, and where it is not finite:
  /// what rounding spoilt at the ends of the range of numbers is no solution, and standing still is always allowed.
  void (*substitute)(RodBatch* batches, Index batch, std::size_t pose, const char* active, const char* rests,
                     double tolerance);
  /// Moves and evaluates.
  void (*move)(RodBatch* batches, Index batch, const char* active, const RodMove& by, MoveSums& sums);
  /// Velocities and energies at the end of a step, to the scene; `quiet`, by lane: hardly moved. The start's pose
  /// becomes the one numbered `pose`.
  void (*finish)(RodBatch* batches, Index batch, const std::array<Index, kLanes>* children, const char* active,
                 std::size_t pose, bool sharpens, RodScene& scene, char* quiet, FinishSums& sums);
};

/// All do the same operations in the same order, so the results are the same to the bit. Null where the machine, or the
/// compiler, cannot.
const RodKernels* plain_rod_kernels();
const RodKernels* avx2_rod_kernels();
/// The fastest there is.
const RodKernels& best_rod_kernels();

}  // namespace vmesh
