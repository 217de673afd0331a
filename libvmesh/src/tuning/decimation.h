#pragma once

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// `mesh` (closed and manifold) reduced to about so many vertices by collapsing edges where that changes volume,
/// boundary and shape least (Lindstrom and Turk 1998, CGAL).
TriMesh decimated(const TriMesh& mesh, std::size_t vertices);

}  // namespace vmesh
