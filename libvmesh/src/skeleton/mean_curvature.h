#pragma once

#include "vmesh/core/progress.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// The curve skeleton of a closed manifold mesh of one component by mean curvature flow (Tagliasacchi et al. 2012,
/// CGAL). A node's radius is the mean distance of the surface's vertices that ended in it; where none did, that of its
/// neighbours. Coarse meshes are divided first. Asks `progress` whether to go on. Throws InvalidInput when the flow
/// leaves nothing, and Cancelled.
Graph mean_curvature_skeleton(const TriMesh& mesh, const Progress& progress);

}  // namespace vmesh::skeleton
