#pragma once

#include "vmesh/core/progress.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// What happened while a surface grew.
struct PaperGrowthReport {
  std::size_t splits = 0;    ///< faces crossed by the centerline and split
  std::size_t refused = 0;   ///< faces crossed behind the front of their segment, or too often, left alone
  std::size_t forced = 0;    ///< vertices that did not settle by themselves and were projected
  std::size_t unclosed = 0;  ///< segments that close a loop and that a single seed cannot cover
};

/// Growth from a single seed per component (paper, section 4): a geodesic sphere at the widest branching node
/// grows until every vertex has reached the vessel boundary and no face is crossed by the centerline.
/// `beta`: weight of Eq. 11. `guarded`: no step is taken after which faces cross; vertices go as far as others let
/// them. Terminates for every input: see the guard in the .cpp.
PaperGrowthReport grow_from_single_seeds(BoundSurface& surface, double beta, bool guarded, const Progress& progress);

}  // namespace vmesh
