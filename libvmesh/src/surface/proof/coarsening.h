#pragma once

#include <functional>

#include "vmesh/core/progress.h"

#include "surface/proof/patch.h"
#include "surface/remesh/elongated_metric.h"

namespace vmesh {

/// Leaves out vertices of a surface for which a limit on the error is proven, as long as it stays proven.
///
/// Edges are collapsed, those first by which the integral of the squared deviation from the boundary grows least; the
/// new vertex lies where it is least (compare Lindstrom and Turk, "Fast and memory efficient polygonal simplification",
/// 1998, who measure volumes between surfaces). In between and at the end, edges are flipped and vertices moved where
/// that makes it smaller. No step lets faces cross, or a face the axis of a vessel, nor makes triangles much worse than
/// they may be in the metric of `longest`: how many times longer than wide they may be at a place of the vessels.
/// Vertices at openings stay, and faces that are not proven. Deviations stay below half the local radius, whatever the
/// limit. Ends when there are `least_vertices`.
///
/// The result is proven like the surface before: the same faces are not. One thread.
void coarsen(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit, std::size_t least_vertices,
             const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress);

}  // namespace vmesh
