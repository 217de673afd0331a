#pragma once

#include <cmath>

#include "vmesh/core/types.h"

namespace vmesh {

/// Inverse mean ratio of a triangle: sum of squared edges / (4 sqrt(3) area). 1 equilateral, infinite degenerate.
inline double inverse_mean_ratio(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double area2 = ab.cross(ac).norm();
  return (ab.squaredNorm() + ac.squaredNorm() + (c - b).squaredNorm()) / (2 * std::sqrt(3.0) * area2);
}

/// Its square.
inline double squared_inverse_mean_ratio(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double edges = ab.squaredNorm() + ac.squaredNorm() + (c - b).squaredNorm();
  return edges * edges / (12 * ab.cross(ac).squaredNorm());
}

/// Power with an exponent >= 0, by multiplications alone.
inline double whole_power(double base, int exponent) {
  double power = 1;
  for (; exponent > 0; exponent /= 2, base *= base) {
    if (exponent % 2 == 1) power *= base;
  }
  return power;
}

/// Value, gradient and Hessian of the sum over triangles (x, b, c) of the inverse mean ratio to the power of 2 `power`,
/// as x moves in the plane spanned by the orthonormal u, w. The triangles' normals are held fixed, which makes the
/// Hessian positive definite. The higher the power, the more the worst triangle counts.
struct PlanarEnergy {
  int power = 1;
  double value = 0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();

  void add(const Vec3& x, const Vec3& b, const Vec3& c, const Vec3& u, const Vec3& w) {
    const Vec3 edge = c - b;
    const Vec3 normal = edge.cross(x - b);
    const double area2 = normal.norm();
    if (!(area2 > 0)) {
      value = std::numeric_limits<double>::infinity();
      return;
    }
    const double scale = 1 / (2 * std::sqrt(3.0));
    const double n = scale * ((x - b).squaredNorm() + (x - c).squaredNorm() + edge.squaredNorm());
    const Vec3 slope_n = scale * 2 * (2 * x - b - c), slope_d = (normal / area2).cross(edge);
    const Eigen::Vector2d dn(slope_n.dot(u), slope_n.dot(w)), dd(slope_d.dot(u), slope_d.dot(w));
    const double f = n / area2;
    const Eigen::Vector2d df = (dn - f * dd) / area2;
    Eigen::Matrix2d hf = (4 * scale * Eigen::Matrix2d::Identity() - dd * df.transpose() - df * dd.transpose()) / area2;
    const int q = 2 * power;
    const double below = whole_power(f, q - 2);
    value += below * f * f;
    gradient += q * below * f * df;
    hessian += q * below * ((q - 1) * df * df.transpose() + f * hf);
  }
};

}  // namespace vmesh
