#pragma once

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Lifts vertices off the boundary so that the signed distance to it averages to zero: a mesh whose vertices lie on a
/// convex wall cuts off what bulges between them. The average is taken around every vertex with the weight of its hat
/// function (1 there, 0 at its neighbours, linear between): the sum over all vertices is the volume, and the surface
/// that has it zero is the best fit by least squares. Adds to the lifts that there are what the faces miss now, then
/// moves vertices to where they belong unless a face would turn over or the way is long. No vertex is lifted beyond
/// `limit`, nor into a vessel nearby. Held vertices stay. Each call comes closer.
void balance(SweepState& state, const ErrorLimit& limit);

/// Takes the lifts of these vertices and those around them back and moves them onto the boundary again.
void sink(SweepState& state, const std::vector<Vertex>& vertices);

}  // namespace vmesh
