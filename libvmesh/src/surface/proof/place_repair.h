#pragma once

#include "surface/proof/refine_to_limit.h"

namespace vmesh {

/// When a place is left alone.
struct RepairEffort {
  std::size_t most_unproven;  ///< faces: it is not begun with where there are more
  std::size_t most_in_vain;   ///< the sum of unproven faces over tries in a row that were in vain
};

/// Mends what refining has left unproven, place by place. Where walls meet at small angles, it depends on chance more
/// than on size which triangles are proven; what is small can be tried often. Around an unproven face some vertices are
/// left out, a small part of the surface is refined anew, notches are closed in it, and it is kept if fewer faces are
/// unproven then. The rest of the surface stays the same.
///
/// Reports progress as "repair". Throws Cancelled.
void repair_places(RefinementOutcome& outcome, const VesselField& field, const RefinementGoal& goal,
                   const RepairEffort& effort, const Progress& progress);

}  // namespace vmesh
