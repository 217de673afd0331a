#pragma once

#include <vector>

#include "vmesh/volume/cone_relations.h"
#include "vmesh/volume/contacts.h"

#include "volume/cone_axes.h"
#include "volume/local_pairs.h"

namespace vmesh {

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

/// What is asked of vessels that are not neighbours, and how far it reaches.
struct ContactQuestion {
  double gap = 0;    ///< smaller radii
  double blend = 0;  ///< of the field

  /// Two cones are no contact if their boxes, grown by this many of their larger radii each, do not overlap.
  double reach() const;
  /// Spheres farther from each other than this are not related, whatever is between them.
  Touch widest_relation() const;
};

/// All such pairs, ordered by (i, j).
std::vector<ContactPair> find_contact_pairs(const ConeRelations& cones, double gap);

/// Those with at least one marked cone, and without their regions.
std::vector<ContactPair> find_contact_pairs_of(const ConeRelations& cones, double gap, const std::vector<char>& marked);

/// Pairs whose cones share a node on either side belong to one region.
void number_regions(const ConeAxes& cones, std::vector<ContactPair>& pairs);

/// The contacts of these pairs, deepest first.
std::vector<Contact> contacts_of(const ConeAxes& cones, const std::vector<ContactPair>& pairs);

}  // namespace vmesh
