#pragma once

#include <array>
#include <optional>

#include "vmesh/core/types.h"

namespace vmesh {

/// Where a centerline segment crosses a triangle.
struct Crossing {
  double t = 0;       ///< parameter on the segment, in [0, 1]
  int direction = 1;  ///< +1: from first to last it leaves through the triangle's front (counter-clockwise) side
};

/// The corners of a triangle, counter-clockwise seen from its front.
using TriangleCorners = std::array<Vec3, 3>;

/// Whether the segment first-last crosses the triangle. Exact predicates. Ties are broken as if the segment were moved
/// by (e, e^2, e^3), e > 0 infinitely small: a polyline's crossings with a closed mesh then add up consistently with
/// which of its ends are inside, and where it pierces the mesh at an edge, at a vertex or with a node of its own, it
/// crosses one face once.
std::optional<Crossing> find_crossing(const Vec3& first, const Vec3& last, const TriangleCorners& triangle);

}  // namespace vmesh
