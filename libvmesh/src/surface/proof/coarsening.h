#pragma once

#include "vmesh/core/progress.h"

#include "surface/proof/coarsening_steps.h"
#include "surface/proof/finished_surface.h"

namespace vmesh {

/// How far vertices are left out.
struct CoarseningGoal {
  ErrorLimit proven;               ///< what stays proven; if not set, nothing need be
  std::size_t least_vertices = 0;  ///< no more are left out once there are no more than that
};

/// Leaves out vertices of a surface as long as a limit on the error stays proven, or down to a number.
///
/// Edges are collapsed, about those first by which the deviation from the boundary grows least; the new vertex lies
/// where it is least (compare Lindstrom and Turk, "Fast and memory efficient polygonal simplification", 1998, who
/// measure volumes between surfaces). In between and at the end, edges are flipped and vertices moved where that makes
/// it smaller. Down to a number, vertices are then exchanged: edges are split where that gains more than collapses cost
/// elsewhere (compare Hoppe et al., "Mesh optimization", 1993). The deviation is the integral of the distance to the
/// power 1.5. No step lets faces cross, or a face the axis of a vessel, nor makes triangles much worse than they may be
/// in the metric of `longest`. Vertices at openings stay, and faces that are not proven. Deviations stay below half the
/// local radius, whatever the limit.
///
/// The result is proven like the surface before: the same faces are not. Steps are measured and proven on all threads;
/// those that share no face are taken together, the cheapest first, so that the bytes are the same with any number.
RefusedSteps coarsen(FinishedSurface& surface, const VesselField& field, const CoarseningGoal& goal,
                     const LongestAt& longest, const Progress& progress);

}  // namespace vmesh
