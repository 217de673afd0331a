#pragma once

#include <vector>

#include "surface/proof/refinement.h"

namespace vmesh {

struct RefinementOutcome {
  FinishedSurface surface;
  ErrorSummary error;
  std::vector<Index> faces;             ///< unproven, other than at openings
  std::vector<UnprovenPlace> unproven;  ///< without those at openings: there is no boundary to compare with

  bool is_met() const { return unproven.empty(); }
  std::size_t unproven_faces() const;
};

/// refine().
RefinementOutcome refine_once(FinishedSurface surface, const VesselField& field, const RefinementGoal& goal,
                              const Progress& progress);

/// Notes which faces are unproven, ascending.
void note_unproven(RefinementOutcome& outcome, std::vector<Index> faces);

}  // namespace vmesh
