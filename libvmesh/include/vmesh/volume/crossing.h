#pragma once

#include <optional>

#include "vmesh/core/types.h"

namespace vmesh {

/// Where a centerline segment crosses a triangle.
struct Crossing {
  double t = 0;       ///< parameter on the segment, in [0, 1]
  int direction = 1;  ///< +1: from first to last it leaves through the triangle's front (counter-clockwise) side
};

/// A triangle with the indices of its corners, which break ties.
struct IndexedTriangle {
  Vec3 corner[3];
  Index index[3];
};

/// Whether the segment first-last crosses the triangle. Exact predicates. Ties are broken so that a polyline which
/// pierces a closed mesh crosses exactly one of the faces around a touched edge or vertex, and exactly one of its
/// segments crosses where a node lies on a face: a point on the triangle's plane counts as in front of it.
std::optional<Crossing> find_crossing(const Vec3& first, const Vec3& last, const IndexedTriangle& triangle);

}  // namespace vmesh
