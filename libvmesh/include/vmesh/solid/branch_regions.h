#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// For every cell the branch of the vessel that is nearest to its middle: deepest within it, or least outside. Numbers
/// are those of find_branches(), as in BranchLabels.
std::vector<Index> branches_of_cells(const VolumeMesh& mesh, const Centerline& centerline);

/// Divides every region by the branches of its cells: "lumen" becomes "lumen_0", "lumen_2" ... in ascending order.
/// `branch`: one per cell; throws InvalidInput if it is not.
void divide_regions(VolumeMesh& mesh, const std::vector<Index>& branch);

}  // namespace vmesh
