#pragma once

#include "vmesh/core/progress.h"

#include "surface/tubes/growth_skeleton.h"

namespace vmesh {

/// The vertices around a hole in the surface, counter-clockwise about the direction out of the vessel.
struct OpenLoop {
  Index node;
  std::vector<Vertex> vertices;
};

struct GuidedGrowthReport {
  std::vector<OpenLoop> open_loops;
  GrowthSummary summary;         ///< with the numbers of the surface's own centerline; buried branches are not in it
  std::size_t filled_loops = 0;  ///< loops of the centerline too short to have a hole
  std::size_t tangled_junctions = 0;  ///< with faces that intersect each other
};

/// Grows a surface whose topology is that of the growth skeleton: tubes ring by ring where a vessel's cross-section is
/// its own, junctions from a seed each where it is not, docked at the tubes' ends. Left open at the ends that `open`
/// tells, one per node, where the vessel has a cross-section of its own there; lids close it for the time being.
GuidedGrowthReport grow_guided(BoundSurface& surface, const std::vector<char>& open, const GenerateOptions& options,
                               const Progress& progress);

}  // namespace vmesh
