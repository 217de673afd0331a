#pragma once

#include "vmesh/image/voxel_image.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The surface around all values of at least `isovalue` by marching cubes (VTK's flying edges), in LPS and mm. Closed,
/// manifold and oriented outwards; everything beyond the image's border counts as outside. Values close to `isovalue`
/// are moved off it, so that no vertex comes closer to a voxel's centre than about a thousandth of a voxel and no
/// vertices coincide. Throws InvalidInput if no value is inside, Unsupported in a build without VTK.
TriMesh contour(const VoxelImage& image, double isovalue);

/// Memory that contour() needs per voxel besides the image itself (bytes, measured, with room for the surface).
inline constexpr double kContourBytesPerVoxel = 8;

}  // namespace vmesh
