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

/// Eq. 10 for all slots that moved.
using Synchroniser = void(const Attachment& attachment, DeformedSurface& surface) noexcept;
namespace plain {
Synchroniser synchronise;
}
namespace avx2 {
Synchroniser synchronise;
}

}  // namespace vmesh
