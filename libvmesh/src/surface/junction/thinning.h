#pragma once

#include "surface/junction/lattice_growth.h"

namespace vmesh {

/// Merges the vertices that are cut off the same point of the lattice into one in their middle, wherever the surface
/// stays closed, 2-manifold and of its genus, and none of its faces turns over: those around them form a disc.
LatticeSurface thinned(const LatticeSurface& surface);

}  // namespace vmesh
