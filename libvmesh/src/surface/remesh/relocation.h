#pragma once

#include "surface/remesh/sweep_state.h"

namespace vmesh {

struct RelocationOptions {
  int power = 1;  ///< of the faces' energies in the sum: the higher, the more the worst counts
  double highest = std::numeric_limits<double>::infinity();  ///< no face's energy rises above that
  double noticeable = 0.02;  ///< move, in target lengths, from which on the neighbours are active in the next sweep
};

/// Moves every active vertex to where the shape energy of its faces is least: one Newton step in its tangent plane,
/// reprojected onto the boundary, taken only if it is an improvement and keeps the faces upright.
void relocate_vertices(SweepState& state);

/// The same for these vertices.
void relocate_vertices(SweepState& state, const std::vector<Vertex>& vertices, const RelocationOptions& options);

}  // namespace vmesh
