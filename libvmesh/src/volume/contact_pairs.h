#pragma once

#include <vector>

#include "vmesh/volume/cone_relations.h"

namespace vmesh {

/// A stretch of a round cone's axis, with the radii at its ends.
struct AxisStretch {
  Vec3 origin, axis;
  double r0 = 0, r1 = 0;

  Vec3 point(double t) const { return origin + t * axis; }
  double radius(double t) const { return r0 + t * (r1 - r0); }
};

/// The stretch of `cone` between parameters `first` and `last`.
AxisStretch stretch_of(const ConeRelations& cones, Index cone, double first = 0, double last = 1);

/// Where two cones come closest, in terms of the wall distance minus `gap` times the smaller local radius.
struct ClosestApproach {
  double excess = 0;    ///< wall distance minus the required gap, mm; negative in a contact
  double s = 0, t = 0;  ///< parameters on the first and the second axis
  double distance = 0;  ///< of the axes there, mm
};

/// Whether the excess of the closest approach is certainly at least `margin` times the sum of the radii there. A quick
/// test: false does not mean the contrary.
bool are_apart(const AxisStretch& first, const AxisStretch& second, double gap, double margin);

ClosestApproach closest_approach(const AxisStretch& first, const AxisStretch& second, double gap);

/// Two cones that are not local to each other and closer than the gap.
struct ContactPair {
  Index i = kNone, j = kNone;  ///< i < j
  double gap = 0;              ///< required between them, in smaller radii
  ClosestApproach closest;
  Index region = kNone;  ///< regions are numbered in the order of their first pairs
};

/// All such pairs, ordered by (i, j).
std::vector<ContactPair> find_contact_pairs(const ConeRelations& cones, double gap);

}  // namespace vmesh
