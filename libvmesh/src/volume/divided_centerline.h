#pragma once

#include <vector>

#include "vmesh/volume/contacts.h"

namespace vmesh {

/// A centerline with nodes added on the segments of another, and where its segments lie on that.
struct DividedCenterline {
  Centerline centerline;
  std::vector<SegmentPiece> pieces;  ///< one per segment
};

/// `centerline` itself: every segment in one piece.
DividedCenterline undivided(const Centerline& centerline);

/// `inner` divides `outer.centerline`; the result tells where its segments lie on what `outer` divides.
DividedCenterline composed(const DividedCenterline& outer, DividedCenterline inner);

/// Every segment can be divided evenly into leaves of at most half its smaller radius; this many.
Index leaf_count_of(const Centerline& centerline, Index segment);

}  // namespace vmesh
