// Closed polygons in space, internal to the module.
#pragma once

#include <span>

#include "vmesh/core/types.h"

namespace vmesh::skeleton {

struct RingShape {
  Vec3 center = Vec3::Zero();  ///< centroid of the projected area
  Vec3 normal = Vec3::Zero();  ///< unit, the ring is counter-clockwise about it; zero without area
  double area = 0;             ///< projected along the normal, mm^2
  double perimeter = 0;        ///< mm
  double radius = 0;           ///< of a circle of that area, mm
  double unevenness = 0;       ///< largest distance from the plane through the center, mm
  double aspect = 0;           ///< length to width, by second moments of the ring; 1: round or square
  double compactness = 0;      ///< area relative to that of an ellipse with these moments; 1: an ellipse, 0: folded
};

RingShape shape_of(std::span<const Vec3> ring);

/// The area between a ring's edges and arcs through its vertices that turn as the ring does, mm^2. Right for circles up
/// to the fourth power of the angle.
double area_of_arcs(std::span<const Vec3> ring, const Vec3& normal);

}  // namespace vmesh::skeleton
