#pragma once

#include <functional>

#include "vmesh/core/progress.h"

#include "surface/proof/patch.h"
#include "surface/remesh/elongated_metric.h"

namespace vmesh {

/// Leaves out vertices of a surface for which a limit on the error is proven, as long as it stays proven.
///
/// Edges are collapsed, those first that leave the surface closest to the boundary; the new vertex lies where the
/// deviations of the faces around it, inwards and outwards, are as small as they can be. In between, edges are flipped
/// and vertices moved where that brings faces closer, so that more can go. No step lets faces cross, or a
/// face the axis of a vessel, nor makes triangles much worse than they may be in the metric of `longest`: how many
/// times longer than wide they may be at a place of the vessels. Vertices at openings stay, and faces that are not
/// proven. Deviations stay below half the local radius, whatever the limit.
///
/// The result is proven like the surface before: the same faces are not. One thread.
void coarsen(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit,
             const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress);

}  // namespace vmesh
