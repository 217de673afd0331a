#pragma once

#include <array>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A face by its vertices' numbers and their positions.
struct PlacedFace {
  Triangle vertices;
  std::array<Vec3, 3> points;
};

/// Whether two faces intersect other than in the vertices or the edge that they have in common. Neither may be
/// degenerate. Exact predicates.
bool intersect(const PlacedFace& x, const PlacedFace& y);

/// Whether a face, not degenerate, meets the segment between two points that are not the same. Exact predicates.
bool meets_segment(const PlacedFace& x, const Vec3& from, const Vec3& to);

/// Whether the corners lie on one line. Exact predicate.
bool is_degenerate(const PlacedFace& x);

}  // namespace vmesh
