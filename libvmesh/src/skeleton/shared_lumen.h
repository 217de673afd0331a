#pragma once

#include "cone_fit.h"
#include "skeleton_graph.h"

namespace vmesh::skeleton {

/// Merges nodes of vessels that lie beside each other in one lumen, far apart along the graph: the legs of a hairpin in
/// a wide vessel, or a vessel that runs along the bulge it comes from. Their cones would have walls between them that
/// the surface does not have. Of every two nodes, the one place between them counts where the surface is nearest to
/// the line that joins them. Each node is merged once, the closest in relation first; call again for the rest. Returns
/// how many went. Loops that close by it are left to break_loops().
std::size_t merge_in_one_lumen(Graph& graph, const SurfaceSamples& samples);

}  // namespace vmesh::skeleton
