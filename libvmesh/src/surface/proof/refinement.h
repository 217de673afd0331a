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

/// A ball in which another of several ways of refinement is taken, because those before did not do.
struct HardPlace {
  Vec3 center = Vec3::Zero();
  double reach = 0;  ///< mm
  int way = 0;       ///< below refinement_ways()
};
int refinement_ways();

/// Adds vertices where the surface is not proven to be within the limit: first where it is farther at the middle of an
/// edge or a face, until it is not, then at the faces that are not proven (ErrorProof). Edges are halved on the
/// boundary, or where they meet a crease between two cones; flips and moves keep triangles good. What has not changed
/// is not proven again. Steps that would make faces cross or turn over are refused. Vertices on openings stay, and
/// nothing is done at faces there, which end where the boundary does not.
///
/// `hard`: the first that holds a point counts. Returns the faces that remain unproven, other than at openings,
/// ascending. Throws Cancelled.
std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                          const std::vector<HardPlace>& hard, const Progress& progress);

struct RefinedError {
  ErrorSummary summary;
  bool is_met = false;  ///< everywhere but at openings
};

/// refine() and close_notches(); where something remains unproven, from the beginning in other ways there, until
/// everything is proven or no way is left. Takes the surface with the fewest unproven faces.
RefinedError refine_to_limit(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                             const Progress& progress);

}  // namespace vmesh
