#pragma once

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Lifts vertices off the boundary so that the signed distance to it averages to zero: a mesh whose vertices lie on a
/// convex wall cuts off what bulges between them. The average around a vertex is weighted by its hat function (1 there,
/// 0 at its neighbours, linear between): the sum over all vertices is the volume error, and the surface with zero
/// averages is the best fit by least squares. Adds the present averages to the lifts, then moves vertices to where they
/// belong unless a face would turn over or the move is long. No vertex is lifted beyond `limit`, nor into a vessel
/// nearby. Held vertices stay. Each call comes closer.
void balance(SweepState& state, const ErrorLimit& limit);

/// Moves vertices that are not at their lifts there, as far as may be.
void return_to_boundary(SweepState& state);

/// Sets the lifts of these vertices and their neighbours to 0 and moves them back onto the boundary.
void drop_lifts(SweepState& state, const std::vector<Vertex>& vertices);

}  // namespace vmesh
