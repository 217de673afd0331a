#pragma once

#include "vmesh/core/progress.h"

#include "surface/growth_skeleton.h"

namespace vmesh {

struct GuidedGrowthReport {
  std::size_t junctions = 0, tubes = 0;
  std::size_t components = 0, cycle_rank = 0;  ///< of the growth skeleton, and so of the surface
  std::size_t filled_loops = 0;                ///< loops of the centerline too short to have a hole
  std::size_t tangled_junctions = 0;           ///< with faces that intersect each other
};

/// Grows a surface whose topology is that of the growth skeleton: tubes ring by ring where a vessel's cross-section is
/// its own, junctions from a seed each where it is not, docked at the tubes' ends.
GuidedGrowthReport grow_guided(BoundSurface& surface, const GenerateOptions& options, const Progress& progress);

}  // namespace vmesh
