#pragma once

#include <vector>

#include "vmesh/volume/contacts.h"

namespace vmesh {

/// A centerline with nodes added on the segments of another, and where its segments lie on the other.
struct DividedCenterline {
  Centerline centerline;
  std::vector<SegmentPiece> pieces;  ///< one per segment
};

/// `centerline` itself: every segment in one piece.
DividedCenterline undivided(const Centerline& centerline);

/// `inner` divides `outer.centerline`; in the result, its segments refer to the centerline that `outer` divides.
DividedCenterline composed(const DividedCenterline& outer, DividedCenterline inner);

/// Number of leaves, of at most half its smaller radius each, into which a segment is divided evenly.
Index leaf_count_of(const Centerline& centerline, Index segment);

}  // namespace vmesh
