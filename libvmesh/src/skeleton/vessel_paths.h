// Paths through the middle of vessels given as voxels, internal to the module.
#pragma once

#include <span>
#include <vector>

#include "vmesh/core/progress.h"

#include "voxel_graph.h"

namespace vmesh::skeleton {

/// An end that is known beforehand: the middle of an opening or of a flat end.
struct KnownEnd {
  Index voxel = kNone;
  double radius = 0;  ///< mm
};

/// A graph of voxels: the middle of every vessel, from tip to tip, and around every loop.
struct VesselPaths {
  std::vector<Index> voxels;                ///< numbers in the VoxelGraph
  std::vector<std::array<Index, 2>> edges;  ///< places in `voxels`
  std::vector<Index> known_ends;            ///< place in `voxels` of every known end; kNone if it has no path
  std::size_t loops = 0;
  std::vector<Index> component;  ///< of every voxel of the VoxelGraph
  std::vector<Index> roots;      ///< of every component, in the VoxelGraph
};

/// Finds paths as follows. Every component has a root: a known end, or the voxel that is farthest from any other. A
/// voxel costs the inverse fourth power of its depth, so shortest paths keep to the middle of vessels, wide and thin
/// alike. Loops, where fronts from the root meet again, get a path along either side. Then the voxel that is farthest
/// from the root gets a path, and so on, until every voxel is near a path: nearer than 1.2 times the depth there plus
/// two voxels. `depth`: distance from the nearest voxel outside, mm; `occupancy`: see smoothed_occupancy().
/// Cost: O(n log n) of the voxels.
VesselPaths find_paths(const VoxelGraph& graph, const std::vector<float>& depth, const std::vector<float>& occupancy,
                       std::span<const KnownEnd> ends, const Progress& progress);

}  // namespace vmesh::skeleton
