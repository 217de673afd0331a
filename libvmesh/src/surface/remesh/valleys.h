#pragma once

#include "surface/remesh/sweep_state.h"

namespace vmesh {

/// Lowers the fineness of vertices where vessels meet in a valley that is rounded more tightly than a vessel, so that
/// faces across it leave hardly more of it open than they cut off around a vessel.
void make_valleys_finer(SweepState& state);

}  // namespace vmesh
