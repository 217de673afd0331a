#pragma once

#include "vmesh/mesh/tri_mesh.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Vertices of faces that intersect although their vessels are neighbours along the graph, and vertices off the
/// boundary: what a local operation can mend. Ascending.
std::vector<Vertex> find_tangles(const SweepState& state);

/// Lets the surroundings of `tangles` relax on the boundary like a rubber sheet, which pulls folds flat. Returns them,
/// ascending, stirred.
std::vector<Vertex> loosen(SweepState& state, const std::vector<Vertex>& tangles);

/// The surface as it is, its vertices by their indices; with its lids or without.
TriMesh indexed_mesh(const SweepState& state, bool with_lids);

/// Vertices of all faces that intersect others, be it of vessels that are no neighbours; ascending.
std::vector<Vertex> find_crossing_walls(const SweepState& state);

}  // namespace vmesh
