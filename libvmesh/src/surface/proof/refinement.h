#pragma once

#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/proof/finished_surface.h"

namespace vmesh {

/// Adds vertices where the surface is not proven to be within the limit: first where it is farther at the middle of an
/// edge or a face, until it is not, then at the faces that are not proven (ErrorProof, shells along normals). Edges are
/// halved on the boundary, or where they meet a crease between two cones; flips and moves keep triangles good. What has
/// not changed is not proven again. Steps that would make faces cross are refused. Vertices on openings stay; there are
/// no more vertices than `most_vertices`.
///
/// Returns the faces that remain unproven, ascending. Throws Cancelled.
std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit,
                          std::size_t most_vertices, const Progress& progress);

}  // namespace vmesh
