#pragma once

#include <vector>

#include "surface/proof/refinement.h"

namespace vmesh {

struct RefinementOutcome {
  FinishedSurface surface;
  std::vector<HardPlace> hard;  ///< with which it was refined
  ErrorSummary error;
  std::vector<UnprovenPlace> unproven;  ///< without those at openings: there is no boundary to compare with

  bool is_met() const { return unproven.empty(); }
  std::size_t unproven_faces() const;
};

/// refine().
RefinementOutcome refine_once(FinishedSurface surface, const VesselField& field, const RefinementGoal& goal,
                              std::vector<HardPlace> hard, const Progress& progress);

/// close_notches() of its surface.
void close_notches(RefinementOutcome& outcome, const VesselField& field, const ErrorLimit& limit);

/// refine() and close_notches() of a surface from the beginning, in other ways where it is not proven, until everything
/// is proven or no way is left. `first`: what is known of the first way. Takes the surface with the fewest unproven
/// faces.
RefinementOutcome refine_in_other_ways(const FinishedSurface& surface, RefinementOutcome first,
                                       const VesselField& field, const RefinementGoal& goal, const Progress& progress);

}  // namespace vmesh
