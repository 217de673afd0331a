#pragma once

#include "vmesh/core/instruction_set.h"

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

/// The end of a step.
struct RodFinish {
  std::size_t pose;  ///< of RodBatch::pose, which becomes the starting pose
  bool sharpens;     ///< makes frames orthonormal
  char* quiet;       ///< set by lane: hardly moved
};

/// The operations on a batch of slots in a step of ImplicitRods. `active`, by lane, says for which slots; the others
/// stay unchanged.
struct RodKernels {
  /// Reads the scene; predicts, and evaluates inertia.
  void (*begin)(RodBatch& batch, const char* active, const RodScene& scene, BeginSums& sums);
  /// Eliminates slots whose children have been eliminated: computes `reduced`, or x for a root.
  void (*eliminate)(RodBatches& tree, Index batch, std::size_t pose, const char* active);
  /// Computes x from the parent's. Zero for lanes in `rests` where it is within the tolerance, and where it is not
  /// finite: a result spoilt by overflow is not a solution, and standing still is always allowed.
  void (*substitute)(RodBatches& tree, Index batch, std::size_t pose, const char* active, const char* rests,
                     double tolerance);
  /// Moves and evaluates.
  void (*move)(RodBatches& tree, Index batch, const char* active, const RodMove& by, MoveSums& sums);
  /// Writes velocities and energies at the end of a step to the scene.
  void (*finish)(RodBatches& tree, Index batch, const char* active, const RodFinish& by, RodScene& scene,
                 FinishSums& sums);
};

namespace plain {
extern const RodKernels kRodKernels;
}
namespace avx2 {
extern const RodKernels kRodKernels;
}

}  // namespace vmesh
