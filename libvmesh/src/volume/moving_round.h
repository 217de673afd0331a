#pragma once

#include "volume/contact_looks.h"
#include "volume/moving.h"

namespace vmesh {

/// Choices in parting vessels where nothing else decides; if a move was in vain, the other choice is tried.
struct MovingChoice {
  bool thicker = false;   ///< the thicker of the two vessels moves
  bool opposite = false;  ///< crossing axes move to the side with less room
};

/// What a round of moving needs to know about the moved and narrowed vessels. `narrowed` divides the original.
struct MovingTask {
  const Centerline& original;
  const DividedCenterline& narrowed;
  const std::vector<ContactPair>& pairs;  ///< their contacts
  const ContactLooks& looks;              ///< at them last
  double gap;                             ///< as in SeparationOptions
  double most_narrowed;                   ///< share of a radius
  MovingChoice choice = {};
};

/// Adds or extends a shift for every contact that would take more than `most_narrowed` of a radius: the thinner vessel
/// (or as `choice` says) moves away from the other, until a little less would be taken. Contacts near a shift that has
/// just changed wait for the next round. Returns the number of shifts added or extended.
int move_apart(const MovingTask& task, Moving& moving);

}  // namespace vmesh
