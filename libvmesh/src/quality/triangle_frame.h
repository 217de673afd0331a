#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A triangle in a frame of its own: corners at (0, 0), (base, 0) and (apex, height), its longest edge the base. In
/// this form the closest point is accurate to within a few roundings of the coordinates however thin the triangle is; a
/// face without area is a segment or a point.
class TriangleFrame {
 public:
  TriangleFrame(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (ab >= bc && ab >= ca) {
      set(a, b, c);
    } else if (bc >= ca) {
      set(b, c, a);
    } else {
      set(c, a, b);
    }
  }

  Vec3 closest(const Vec3& p) const {
    const Vec3 r = p - origin_;
    double x = r.dot(along_), y = r.dot(up_);
    clamp(x, y);
    return origin_ + x * along_ + y * up_;
  }

  double squared_distance(const Vec3& p) const {
    const Vec3 r = p - origin_;
    double x = r.dot(along_), y = r.dot(up_);
    clamp(x, y);
    return (r - x * along_ - y * up_).squaredNorm();
  }

  /// Distances of the foot of `p` on the triangle's plane from the edges, positive on the inner side.
  std::array<double, 3> distances_from_edges(const Vec3& p) const {
    const Vec3 r = p - origin_;
    const double x = r.dot(along_), y = r.dot(up_), rest = base_ - apex_;
    if (height_ == 0) return {0, 0, 0};
    return {y, (height_ * x - apex_ * y) / std::hypot(height_, apex_),
            (height_ * (base_ - x) - rest * y) / std::hypot(height_, rest)};
  }

 private:
  static constexpr double kNothing = 1e-100;  // mm; squares of smaller numbers underflow

  void set(const Vec3& first, const Vec3& last, const Vec3& top) {
    origin_ = first;
    base_ = (last - first).norm();
    along_ = base_ > 0 ? Vec3((last - first) / base_) : Vec3(Vec3::Zero());
    apex_ = std::clamp((top - first).dot(along_), 0.0, base_);
    Vec3 rise = top - first;
    for (int i = 0; i < 2; ++i) rise -= rise.dot(along_) * along_;  // once is not accurate enough for a thin triangle
    height_ = rise.norm();
    if (height_ < kNothing) height_ = 0;
    up_ = height_ > 0 ? Vec3(rise / height_) : Vec3(Vec3::Zero());
  }

  // Moves a point of the plane to the closest point of the triangle. The angles at the base are acute.
  void clamp(double& x, double& y) const {
    if (!(y > 0)) {
      x = std::clamp(x, 0.0, base_);
      y = 0;
      return;
    }
    const double rest = base_ - apex_;
    const bool beyond_left = apex_ * y > height_ * x, beyond_right = rest * y > height_ * (base_ - x);
    if (!beyond_left && !beyond_right) return;
    const double left = beyond_left ? share(x, y, apex_) : 1;
    if (beyond_right && left == 1) {  // not on the left edge, or at its upper end
      const double right = share(base_ - x, y, rest);
      x = base_ - right * rest;
      y = right * height_;
    } else {
      x = left * apex_;
      y = left * height_;
    }
  }

  // Where on the edge from (0, 0) to (run, height) the point (x, y) comes closest, 0 to 1.
  double share(double x, double y, double run) const {
    return std::clamp((x * run + y * height_) / (run * run + height_ * height_), 0.0, 1.0);
  }

  Vec3 origin_, along_, up_;  // unit vectors; zero where the triangle has no extent
  double base_, apex_, height_;
};

}  // namespace vmesh
