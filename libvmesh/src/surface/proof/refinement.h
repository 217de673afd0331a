#pragma once

#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/proof/finished_surface.h"
#include "surface/proof/refinement_way.h"

namespace vmesh {

struct RefinementGoal {
  ErrorLimit limit;
  Placement placement = Placement::balanced;  ///< of vertices
  std::size_t most_vertices = 0;
  int way = 0;                 ///< below refinement_ways()
  int patience = 6;            ///< rounds in which no more area is proven
  bool bends_at_once = false;  ///< shells, not only where nearly everything is proven
};

/// Adds vertices where the surface is not proven to be within the limit: first where it is farther at the middle of an
/// edge or a face, until it is not, then at the faces that are not proven (ErrorProof). Edges are halved on the
/// boundary, or where they meet a crease between two cones; flips and moves keep triangles good. What has not changed
/// is not proven again. Steps that would make faces cross or turn over are refused. Vertices on openings and
/// held ones stay, and nothing is done at faces there: those at openings end where the boundary does not.
///
/// Returns the faces that remain unproven, other than at openings, ascending. Throws Cancelled.
std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                          const Progress& progress);

}  // namespace vmesh
