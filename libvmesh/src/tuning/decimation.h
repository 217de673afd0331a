#pragma once

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Which edges are collapsed first, and where the new vertex lies.
enum class Decimation {
  volume,   ///< where volume, boundary and shape change least (Lindstrom and Turk 1998)
  quadrics  ///< where the squared distances from the planes of the faces are least (Garland and Heckbert 1997)
};

/// `mesh` (closed and manifold) reduced to about this number of vertices by collapsing edges (CGAL).
TriMesh decimated(const TriMesh& mesh, std::size_t vertices, Decimation order = Decimation::volume);

}  // namespace vmesh
