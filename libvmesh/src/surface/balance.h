#pragma once

#include "surface/sweep_state.h"

namespace vmesh {

/// Lifts vertices off the boundary so that the signed distance to it, averaged over the faces around a vertex, is zero:
/// a mesh whose vertices lie on a convex wall cuts off what bulges between them. Adds to the lifts that there are what
/// the faces miss now, then moves vertices to where they belong unless a face would turn over or the way is long.
/// Held vertices stay. Each call comes closer; where the mesh is even the first one is exact.
void balance(SweepState& state);

/// Takes the lifts of these vertices and those around them back and moves them onto the boundary again.
void sink(SweepState& state, const std::vector<Vertex>& vertices);

}  // namespace vmesh
