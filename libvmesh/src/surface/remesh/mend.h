#pragma once

#include "vmesh/core/progress.h"

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Mends triangles of equiangle skewness above `limit` that cannot improve while vertices keep to the boundary and the
/// size field: takes flips, collapses and moves that lower the worst skewness around, whether or not they leave the
/// boundary, but never makes faces cross. Guards the surface from then on. Returns whether there were any such
/// triangles.
/// `progress` is polled for cancellation.
bool mend_worst_faces(BoundSurface& surface, double limit, const Progress& progress = {});

/// Improves triangles that are not bad but could be better: like mending, but vertices stay at their lifts from the
/// boundary, none are added, and moves leave the faces around hardly farther from it.
void improve_worst_faces(BoundSurface& surface, double limit, const Progress& progress = {});

}  // namespace vmesh
