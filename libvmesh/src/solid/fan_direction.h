#pragma once

#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// The direction that sees all faces of a fan best, and how well.
struct FanDirection {
  Vec3 way = Vec3::Zero();  ///< unit length
  double least = -1;        ///< of the dot products with the faces' unit normals; 0 or less: it does not see all
};

/// The unit vector whose least dot product with `normals` (unit vectors, at least one) is largest: the axis of the
/// narrowest cone around them. Exact up to rounding if there is a direction that sees all; valences are small.
FanDirection best_direction(const std::vector<Vec3>& normals);

/// The same among the vectors perpendicular to the unit vector `plane`.
FanDirection best_direction_in_plane(const std::vector<Vec3>& normals, const Vec3& plane);

}  // namespace vmesh
