#pragma once

#include "surface/junction/lattice_growth.h"

namespace vmesh {

/// Merges the vertices that were cut next to the same lattice point into one at their mean, wherever the surface stays
/// closed, 2-manifold and of the same genus (the faces around them form a disc) and no face turns over.
LatticeSurface thinned(const LatticeSurface& surface);

}  // namespace vmesh
