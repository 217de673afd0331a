#pragma once

#include <array>

#include "vmesh/core/types.h"

namespace vmesh {

/// Corners of a wedge in the order of vmesh::Wedge.
using WedgeCorners = std::array<Vec3, 6>;

/// Bezier coefficients of the determinant of a wedge's map (linear between three corners, and from these to the other
/// three): number 3 k + i is that of power k of three along the edge at corner i. All positive: the map is one to one.
/// Their mean is twice the volume.
inline std::array<double, 9> jacobian_coefficients(const WedgeCorners& p) {
  const Vec3 u0 = p[1] - p[0], v0 = p[2] - p[0], u1 = p[4] - p[3], v1 = p[5] - p[3];
  const std::array<Vec3, 3> normal = {u0.cross(v0), (u0.cross(v1) + u1.cross(v0)) / 2, u1.cross(v1)};
  std::array<double, 9> coefficients;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) coefficients[3 * k + i] = normal[k].dot(p[i + 3] - p[i]);
  }
  return coefficients;
}

}  // namespace vmesh
