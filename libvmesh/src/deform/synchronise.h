#pragma once

#include "vmesh/deform/surface_binding.h"

namespace vmesh {

/// The binding to synchronise.
struct Attachment {
  std::span<const SurfaceBinding::Group> groups;
  const SurfaceBinding::Rest& rest;
  const Pose& pose;
  std::span<const char> moved;  ///< by slot; empty: everything
};

/// Eq. 10 for all slots that moved, with one instruction set. All do the same operations in the same order, so the
/// results are the same to the bit.
using Synchroniser = SurfaceBinding::Synchroniser;
Synchroniser plain_synchroniser();
/// Null where the machine or the compiler does not support AVX2.
Synchroniser avx2_synchroniser();
Synchroniser best_synchroniser();

}  // namespace vmesh
