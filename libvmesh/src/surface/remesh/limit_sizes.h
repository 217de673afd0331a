#pragma once

#include "vmesh/surface/generate.h"

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Lowers the fineness of vertices around which edges of `edge_per_radius` local radii would cut off more of a vessel
/// than a limit lets them: at ends, which are round in both directions, and in valleys between vessels.
void make_finer_for(SweepState& state, double edge_per_radius, const ErrorLimit& limit);

}  // namespace vmesh
