#pragma once

#include "vmesh/mesh/tri_mesh.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Vertices off the boundary; ascending.
std::vector<Vertex> find_strays(const SweepState& state);

/// Whether so many vertices are off the boundary that the surface hangs across a hole that the volume has and the graph
/// has not, as where vessels part and are rounded together again: no local operation mends that.
bool hangs(const SweepState& state, const std::vector<Vertex>& strays);

/// Vertices of intersecting faces whose vessels are neighbours along the graph, and vertices off the boundary: what
/// local operations can mend. If it hangs, those off the boundary only. Ascending.
std::vector<Vertex> find_tangles(const SweepState& state);

/// Relaxes the surroundings of `tangles` on the boundary like a rubber sheet, which pulls folds flat. Stirs and returns
/// their vertices, ascending.
std::vector<Vertex> loosen(SweepState& state, const std::vector<Vertex>& tangles);

/// The current surface, with the indices of its vertices kept, with or without its lids.
TriMesh indexed_mesh(const SweepState& state, bool with_lids);

/// Vertices of all intersecting faces, including those of vessels that are not neighbours; ascending.
std::vector<Vertex> find_crossing_walls(const SweepState& state);

}  // namespace vmesh
