// Where loops are thinnest, internal to the module.
#pragma once

#include <vector>

#include "vmesh/skeleton/extract_centerline.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// The loops of a graph of voxel paths, thinnest contact first. The neck of a loop is its weakest stretch between
/// branchings: a short one between two vessels that kiss, thin beside both; without such a contact, the thinnest
/// stretch. With `open`, contacts are removed, and other stretches cut off where they branch off at their thinner end,
/// never in the middle.
std::vector<VesselLoop> find_loops(Graph& graph, double voxel, bool open);

}  // namespace vmesh::skeleton
