#pragma once

#include "volume/moving.h"

namespace vmesh {

/// How vessels part where nothing else decides: what was in vain is tried the other way round.
struct MovingChoice {
  bool thicker = false;   ///< of the two vessels moves
  bool opposite = false;  ///< of crossing axes, the way to the side with less room
};

/// What one look at moved and narrowed vessels needs to know. `narrowed` divides the original.
struct MovingTask {
  const Centerline& original;
  const DividedCenterline& narrowed;
  double gap, blend;     ///< as in SeparationOptions
  double most_narrowed;  ///< share of a radius
  MovingChoice choice = {};
};

/// Adds or extends a shift for every contact that would take more than `most_narrowed` of a radius: the thinner vessel
/// (or as `choice` says) is to move away from the other, so far that a little less would be taken. Contacts near a
/// shift that has just changed wait for the next look. Returns the number of shifts added or extended.
int move_apart(const MovingTask& task, Moving& moving);

}  // namespace vmesh
