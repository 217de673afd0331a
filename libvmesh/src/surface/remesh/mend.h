#pragma once

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Takes the worst triangles, of equiangle skewness above `limit`, out of a surface where keeping to the boundary or to
/// the size field does not let them become better: flips, collapses and moves that lower the worst skewness around,
/// wherever that leads, but never to faces that cross each other. Guards the surface from then on.
/// Returns whether there were any such triangles.
bool mend_worst_faces(BoundSurface& surface, double limit);

/// The same for triangles that are not bad but could be better: vertices stay at their lifts from the boundary, none are
/// added, and those that move leave the faces around hardly farther from it.
void ease_worst_faces(BoundSurface& surface, double limit);

}  // namespace vmesh
