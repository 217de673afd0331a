#pragma once

#include "solid/core.h"

namespace vmesh {

/// Makes the worst tetrahedra better: moves added points, and adds others. No tetrahedron becomes worse
/// than the worst it replaces; the surface stays as it is. Deterministic.
void improve_core(const CoreSurface& surface, Core& core);

/// Tetrahedra whose shape is worse than `limit`. Shape: the smaller of the smallest sine of an angle between faces, and
/// 1.2 times 3 inradius / circumradius.
struct BadPlaces {
  double least = 1;             ///< shape of any tetrahedron
  std::vector<Index> vertices;  ///< of the surface, at bad ones; ascending
};
BadPlaces bad_places(const CoreSurface& surface, const Core& core, double limit);

}  // namespace vmesh
