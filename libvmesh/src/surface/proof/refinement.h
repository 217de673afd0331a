#pragma once

#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/proof/finished_surface.h"

namespace vmesh {

struct RefinementGoal {
  ErrorLimit limit;
  Placement placement = Placement::balanced;  ///< of vertices
  std::size_t most_vertices = 0;
};

/// Adds vertices where the surface is not proven to be within the limit: first where it is farther at the middle of an
/// edge or a face, until it is not, then at the faces that are not proven (ErrorProof, shells along normals). Edges are
/// halved on the boundary, or where they meet a crease between two cones; flips and moves keep triangles good. What has
/// not changed is not proven again. Steps that would make faces cross are refused. Vertices on openings stay,
/// and nothing is done at faces there, which end where the boundary does not.
///
/// Returns the other faces that remain unproven, ascending. Throws Cancelled.
std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                          const Progress& progress);

}  // namespace vmesh
