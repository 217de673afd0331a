#pragma once

#include <array>

#include "solid/core.h"

namespace vmesh {

/// Makes the worst tetrahedra better: moves added points, and adds others. No tetrahedron becomes worse
/// than the worst it replaces; the surface stays as it is. Deterministic.
void improve_core(const CoreSurface& surface, Core& core);

/// The smaller of the smallest sine of an angle between faces, and 1.2 times 3 inradius / circumradius: two measures,
/// which find different faults, weighted so that both are about equal in shapes that are barely good. Negative if the
/// corners are the wrong way round.
double tetrahedron_shape(const std::array<Vec3, 4>& corners);

/// Tetrahedra whose shape is worse than `limit`.
struct BadPlaces {
  double least = 1;             ///< shape of any tetrahedron
  std::vector<Index> vertices;  ///< of the surface, at bad ones; ascending
};
BadPlaces bad_places(const CoreSurface& surface, const Core& core, double limit);

}  // namespace vmesh
