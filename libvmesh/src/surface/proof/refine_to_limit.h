#pragma once

#include "surface/proof/refinement.h"

namespace vmesh {

struct RefinedError {
  ErrorSummary summary;
  bool is_met = false;  ///< everywhere but at openings
};

/// refine() and close_notches(); where something remains unproven, from the beginning in other ways there, until
/// everything is proven or no way is left. Takes the surface with the fewest unproven faces.
RefinedError refine_to_limit(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                             const Progress& progress);

}  // namespace vmesh
