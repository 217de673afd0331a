// What several formats of volume meshes have in common. Internal to the module.
#pragma once

#include <vector>

#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/volume_faces.h"

namespace vmesh::io {

/// A VTU file of the cells, and of the faces of the boundary if their sides are given (sides_of_boundary()).
void write_grid(std::ostream& out, const VolumeMesh& mesh, const std::vector<CellSide>& sides,
                const VolumeAttributes& attributes, const VolumeMetadata& metadata);

}  // namespace vmesh::io
