#pragma once

#include <algorithm>

#include "synth/portable_math.h"

namespace vmesh {

/// Distance between the segments a0 a1 and b0 b1 (Ericson, Real-Time Collision Detection, 5.1.9).
inline double segment_distance(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  using portable::dot;
  const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 1e-12 * uu * vv ? std::clamp((uv * vw - uw * vv) / determinant, 0.0, 1.0) : 0.0;
  double t = (uv * s + vw) / vv;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  }
  return portable::norm(w + s * u - t * v);
}

}  // namespace vmesh
