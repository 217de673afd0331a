// How deep inside the vessels a voxel is, internal to the module.
#pragma once

#include <vector>

#include "voxel_graph.h"

namespace vmesh::skeleton {

/// Distance of every voxel's centre from the nearest centre outside, mm. Exact for a grid with perpendicular axes
/// (Felzenszwalb and Huttenlocher 2012, along the runs inside).
std::vector<float> boundary_distances(const VoxelGraph& graph);

/// The share of every voxel's surroundings that is inside: the set smoothed by a Gaussian of one voxel.
std::vector<float> smoothed_occupancy(const VoxelSet& voxels);

}  // namespace vmesh::skeleton
