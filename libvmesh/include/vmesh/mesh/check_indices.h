#pragma once

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Throws InvalidInput if a face names a vertex that does not exist.
void check_indices(const TriMesh& mesh);

}  // namespace vmesh
