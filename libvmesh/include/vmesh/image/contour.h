#pragma once

#include "vmesh/image/voxel_image.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The surface around all values of at least `isovalue` by marching cubes (VTK's flying edges), in LPS and mm. Closed,
/// manifold and oriented outwards: beyond its border the image is taken to be outside. Where a value is nearly
/// `isovalue`, it is moved off it so that no vertex comes closer to a voxel's centre than about a thousandth of a
/// voxel: there are no coincident vertices. Throws InvalidInput when no value is inside, Unsupported in a build without
/// VTK.
TriMesh contour(const VoxelImage& image, double isovalue);

/// Memory that contour() takes for every voxel, beside the image itself (bytes, measured, with room for the surface).
inline constexpr double kContourBytesPerVoxel = 8;

}  // namespace vmesh
