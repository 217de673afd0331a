// Faces divided by a plane, and the two sides taken apart.
#pragma once

#include <map>
#include <optional>

#include "vmesh/surface/cut_surface.h"

#include "surface/cut/plane_snap.h"

namespace vmesh {

/// The surface parted along the loop, with caps, but without bindings; nothing if what the plane cuts is not one
/// simple ring.
std::optional<CutSurface> part_at_plane(const SurfaceAtPlane& surface, const PlaneLoop& loop,
                                        const std::vector<Index>& in_plane);

}  // namespace vmesh
