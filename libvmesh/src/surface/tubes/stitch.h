#pragma once

#include <span>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Faces that join a loop of vertices to the next one along the branch, both counter-clockwise about its direction. Of
/// all bands that start at the bottom vertex closest to the top, the one with the least sum of squared edges. Indices
/// are into `bottom` and, from bottom.size() on, into `top`. Each loop needs at least three vertices.
std::vector<Triangle> stitch(std::span<const Vec3> bottom, std::span<const Vec3> top);

}  // namespace vmesh
