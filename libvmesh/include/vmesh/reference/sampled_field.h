#pragma once

#include "vmesh/image/voxel_image.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// The vessel volume of a centerline (plain union of round cones) on cubic voxels of `voxel` mm along the LPS axes: the
/// negated signed distance, so that the vessel is where values are at least 0. Exact within two voxels of the boundary
/// on the outside; clamped at two voxels. Inside, the depth is that in the deepest single cone. Throws InvalidInput
/// unless 0 < voxel, and for more than 2^31 voxels; Unsupported if they do not fit into free memory.
VoxelImage sample_field(const Centerline& centerline, double voxel);

}  // namespace vmesh
