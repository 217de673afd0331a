// Ends that point at other vessels over a gap, internal to the module.
#pragma once

#include <vector>

#include "vmesh/skeleton/extract_centerline.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// Joins free ends with other components of the graph that they point at (within 60 degrees) over gaps of up to `join`
/// times the smaller radius, or three voxels if that is more; short gaps straight ahead first, and never so that a loop
/// closes. Gaps of half that, or of three voxels, are joined
/// whatever the direction.
std::vector<JoinedGap> join_ends(Graph& graph, double join, double voxel);

}  // namespace vmesh::skeleton
