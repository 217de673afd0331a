#pragma once

#include "surface/remesh/remesher.h"

namespace vmesh {

/// Makes the worst triangles better at the cost of those around them: vertices move and edges flip to reduce the
/// largest energy instead of the sum, and a flip is kept if it has paid off once its surroundings have settled. Faces
/// below `good_energy` (SweepState::energy) are left alone.
void polish(SweepState& state, Remesher& remesher, double good_energy);

}  // namespace vmesh
