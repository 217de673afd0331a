#pragma once

#include "vmesh/centerline/centerline.h"

#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// Points spread over a surface, each representing a share of its area.
struct SurfaceSamples {
  std::vector<Vec3> points;
  std::vector<double> areas;  ///< mm^2
};

/// Samples at the midpoints of the edges. Sums over them are exact for quadratic functions on faces, such as (nearly)
/// the distance of flat faces to a round vessel, so a coarse surface keeps its mean radius.
SurfaceSamples samples_of(const TriMesh& mesh);

/// Moves the nodes of `graph` and changes their radii so that the boundary of the union of its round cones comes as
/// close to the samples as possible: weighted least squares of the signed distances (Gauss-Newton, at most `rounds`
/// steps), with a little weight on smooth chains. Far samples count less, as they may belong to a region that the graph
/// does not reach. Ends thus come to lie where their spheres touch the surface's ends.
void fit_cones(Graph& graph, const SurfaceSamples& samples, int rounds);

/// The same for nodes that were merged and those around them; the others stay.
void fit_merged_cones(Graph& graph, const SurfaceSamples& samples, int rounds);

/// Throws InvalidInput if `graph` is not a valid centerline.
Centerline to_centerline(const Graph& graph);

}  // namespace vmesh::skeleton
