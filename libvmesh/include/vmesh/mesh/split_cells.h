#pragma once

#include <vector>

#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

struct SplitCells {
  VolumeMesh mesh;                  ///< of tetrahedra alone; points, names and triangles of the boundary as before
  std::vector<Index> cell_origins;  ///< the cell before of every cell; those that were tetrahedra come first
};

/// Cuts every wedge into three tetrahedra and every pyramid into two, each of their quads through the one of its
/// corners with the lowest number, so that cells on both sides agree (J. Dompierre et al., How to subdivide pyramids,
/// prisms and hexahedra into tetrahedra, 8th International Meshing Roundtable, 1999). Quads of the boundary become two
/// triangles where they were. Throws InvalidInput, naming the cell and its place, if one of its tetrahedra has no
/// volume.
SplitCells split_cells(const VolumeMesh& mesh);

/// The attributes of the split mesh, from those of the one before.
VolumeAttributes split_attributes(const VolumeAttributes& attributes, const std::vector<Index>& cell_origins);

}  // namespace vmesh
