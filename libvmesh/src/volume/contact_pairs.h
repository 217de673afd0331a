#pragma once

#include <vector>

#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A stretch of a round cone's axis, with the radii at its ends.
struct AxisStretch {
  Vec3 origin, axis;
  double r0 = 0, r1 = 0;

  Vec3 point(double t) const { return origin + t * axis; }
  double radius(double t) const { return r0 + t * (r1 - r0); }
};

/// The stretch of `cone` between parameters `first` and `last`.
AxisStretch stretch_of(const VesselField& field, Index cone, double first = 0, double last = 1);

/// Where two cones come closest, by the wall distance less `gap` times the smaller of the radii there.
struct ClosestApproach {
  double excess = 0;    ///< wall distance less the gap asked for, mm; negative in a contact
  double s = 0, t = 0;  ///< parameters on the first and the second axis
  double distance = 0;  ///< of the axes there, mm
};

/// Whether vessels are so far apart that the excess of their closest approach is `margin` sums of the radii there at
/// least. Says no where only a closer look can tell.
bool are_apart(const AxisStretch& first, const AxisStretch& second, double gap, double margin);

ClosestApproach closest_approach(const AxisStretch& first, const AxisStretch& second, double gap);

/// Two cones that are not local to each other and closer than the gap.
struct ContactPair {
  Index i = kNone, j = kNone;  ///< i < j
  double gap = 0;              ///< asked for between them, in smaller radii
  ClosestApproach closest;
  Index region = kNone;  ///< regions are numbered in the order of their first pairs
};

/// All such pairs, ordered by (i, j).
std::vector<ContactPair> find_contact_pairs(const VesselField& field, double gap);

}  // namespace vmesh
