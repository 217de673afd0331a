#pragma once

#include "fit/fit_mesh.h"

namespace vmesh::fitting {

/// Halves all edges of a packed surface that are not on its border; faces without such an edge become four. Sizes are
/// halved.
void subdivide(FitMesh& surface);

}  // namespace vmesh::fitting
