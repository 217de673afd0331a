// Holes in a set of voxels, internal to the module.
#pragma once

#include "voxel_set.h"

namespace vmesh::skeleton {

struct FilledHoles {
  std::size_t cavities = 0;  ///< voxels of cavities, whatever their size
  std::size_t pinholes = 0;  ///< voxels of tunnels and notches of a voxel or two
};

/// Fills cavities (voxels outside with no way to the border of the grid over faces) and pinholes (voxels with at least
/// 19 of 26 neighbours inside; in a slit between two vessels there are 18). Never takes a voxel away. Numbers the
/// voxels.
FilledHoles fill_holes(VoxelSet& voxels);

}  // namespace vmesh::skeleton
