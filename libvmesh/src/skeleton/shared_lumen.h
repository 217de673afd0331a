#pragma once

#include "cone_fit.h"
#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// Merges stretches that lie beside each other in one lumen: the legs of a hairpin in a wide vessel, or a vessel that
/// runs along the bulge it comes from. Their cones would have a wall between them that the surface does not have. Two
/// nodes that are near each other, far apart along the graph and in one lumen according to the samples are merged, and
/// with them the nodes of both legs up to where these meet, pair by pair. Each node is merged at most once, relatively
/// closest pairs first; call again for the rest. Returns the number of nodes removed; they remain without an edge until
/// compact().
std::size_t merge_in_one_lumen(Graph& graph, const SurfaceSamples& samples);

}  // namespace vmesh::skeleton
