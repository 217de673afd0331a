#pragma once

#include "surface/remesh/remesher.h"

namespace vmesh {

/// Makes the worst triangles better at the cost of those around them: vertices move, edges flip for the largest energy
/// instead of the sum, and a flip is kept if it has paid off once its surroundings have come to rest.
void polish(SweepState& state, Remesher& remesher);

}  // namespace vmesh
