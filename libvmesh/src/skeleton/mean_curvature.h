#pragma once

#include "vmesh/core/progress.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// The curve skeleton of a closed manifold mesh of one component by mean curvature flow (Tagliasacchi et al. 2012,
/// CGAL). A node's radius is the mean distance of the surface's vertices that ended up at it, or that of its neighbours
/// if there are none. Coarse meshes are subdivided first. Polls `progress` for cancellation. Throws InvalidInput if the
/// flow leaves nothing, and Cancelled.
Graph mean_curvature_skeleton(const TriMesh& mesh, const Progress& progress);

}  // namespace vmesh::skeleton
