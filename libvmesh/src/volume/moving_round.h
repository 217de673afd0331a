#pragma once

#include "volume/moving.h"

namespace vmesh {

/// What one look at moved and narrowed vessels needs to know. `narrowed` divides the original.
struct MovingTask {
  const Centerline& original;
  const DividedCenterline& narrowed;
  double gap, blend;     ///< as in SeparationOptions
  double most_narrowed;  ///< share of a radius
};

/// Adds or extends a shift for every contact that would take more than `most_narrowed` of a radius: the thinner vessel
/// is to move away from the other, so far that a little less would be taken. Contacts near a shift that has just
/// changed wait for the next look. Returns the number of shifts added or extended.
int move_apart(const MovingTask& task, Moving& moving);

}  // namespace vmesh
