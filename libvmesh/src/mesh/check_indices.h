#pragma once

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Throws InvalidInput where a face names a vertex that is not there.
void check_indices(const TriMesh& mesh);

}  // namespace vmesh
