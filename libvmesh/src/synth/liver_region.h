#pragma once

#include <algorithm>
#include <cmath>

#include "vmesh/core/types.h"

// The liver-shaped region of synthetic trees, LPS, mm.
namespace vmesh::liver {

/// Where the portal vein enters, and where it heads.
inline const Vec3 kHilum(12, 8, -6);
inline const Vec3 kInward(-0.34, -0.10, 0.935);

/// Negative inside. Its slope is at most 1: a sphere around p of radius -region(p) is inside.
inline double region(const Vec3& p) {
  // An ellipsoid for the dome under the diaphragm ...
  const Vec3 s(105, 76, 68);
  const double x = p.x() / s.x(), y = p.y() / s.y(), z = p.z() / s.z();
  const double dome = (std::sqrt(x * x + y * y + z * z) - 1) * s.z();
  // ... cut by the visceral surface, which rises to the left, so that the left lobe ends in a wedge.
  const double a = 0.40, b = 0.15;
  const double visceral = (-22 + a * p.x() + b * p.y() - p.z()) / std::sqrt(1 + a * a + b * b);
  // A smooth maximum rounds the edge.
  const double width = 16;
  const double h = std::max(width - std::abs(dome - visceral), 0.0) / width;
  return std::max(dome, visceral) + h * h * width / 4;
}

}  // namespace vmesh::liver
