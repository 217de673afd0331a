#pragma once

#include "surface/sweep_state.h"

namespace vmesh {

/// Moves every active vertex to where the shape energy of its faces is least: one Newton step in its tangent plane,
/// reprojected onto the boundary, taken only if it is an improvement and keeps the faces upright.
void relocate_vertices(SweepState& state, int power = 1);

}  // namespace vmesh
