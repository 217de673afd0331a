#pragma once

#include "vmesh/deform/surface_binding.h"

namespace vmesh {

/// What synchronise() reads.
struct Attachment {
  std::span<const SurfaceBinding::Run> runs;
  const SurfaceBinding::Block* blocks;
  const Pose& pose;
  std::span<const char> moved;  ///< by slot; empty: everything
};

/// Eq. 10 for all runs that moved.
void synchronise(const Attachment& attachment, DeformedSurface& surface) noexcept;

}  // namespace vmesh
