#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"

#include "surface/bound_surface.h"

namespace vmesh {

/// Turns a grown surface into a good one: edges are split, collapsed and flipped towards a size field proportional
/// to the local radius and towards regular valence, faces whose centre is too far from the boundary are split
/// edge-centrically, vertices move in their tangent plane to where their triangles' shape energy is least and are
/// reprojected. Topology is kept. Uses around, max_center_distance and sweeps of the options.
void optimize(BoundSurface& surface, const GenerateOptions& options, const Progress& progress);

}  // namespace vmesh
