#pragma once

#include <vector>

#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Of a mesh whose points have moved from `rest`, where all cells were positive: moves points on so that cells which
/// are flat, turned over or nearly so become positive, as far as possible, then tetrahedra with an angle of less than 8
/// degrees less flat, or as flat as they were. What has a shape stays where it is: points
/// of the boundary, and those of faces between regions, unless these are the same but for the branch
/// (divide_regions()). Returns how many points moved on. Deterministic. Throws InvalidInput if `rest` is not as long as
/// the points, and for cells with corners that do not exist.
std::size_t mend_cells(VolumeMesh& mesh, const std::vector<Vec3>& rest);

}  // namespace vmesh
