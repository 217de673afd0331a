#pragma once

#include "surface/remesh/sweep_state.h"

namespace vmesh {

struct RelocationOptions {
  int power = 1;  ///< of the energies in the sum: the higher, the more the worst face counts
  double highest = std::numeric_limits<double>::infinity();  ///< no face's energy may rise above this
  double noticeable = 0.02;  ///< in target lengths: a longer move makes the neighbours active in the next sweep
};

/// Moves every active vertex to where the shape energy of its faces is least: one Newton step in its tangent plane,
/// reprojected onto the boundary, taken only if it is an improvement and keeps the faces upright.
void relocate_vertices(SweepState& state);

/// The same for these vertices.
void relocate_vertices(SweepState& state, const std::vector<Vertex>& vertices, const RelocationOptions& options);

}  // namespace vmesh
