#pragma once

#include <algorithm>

#include "vmesh/deform/rod_tree.h"

namespace vmesh {

/// A displacement and a rotation vector, or a force and a torque.
struct Spatial {
  Vec3 linear = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
};

/// a b and a^T b. Written out because Eigen calls a function for each coefficient of a sum of products: half the time.
[[gnu::always_inline]] inline Mat3 product(const Mat3& a, const Mat3& b) {
  Mat3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) r(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return r;
}
[[gnu::always_inline]] inline Mat3 transposed_product(const Mat3& a, const Mat3& b) {
  Mat3 r;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) r(i, j) = a(0, i) * b(0, j) + a(1, i) * b(1, j) + a(2, i) * b(2, j);
  return r;
}

/// Where a difference that must be positive is lost to rounding, it is replaced by this times the minuend.
constexpr double kRounding = 1e-15;

/// Inverse of a symmetric positive definite 3x3 matrix by L D L^T. A pivot that rounding made too small or negative is
/// raised, which makes the inverse smaller: the safe side for a stiffness matrix.
[[gnu::always_inline]] inline Mat3 inverse(const Mat3& m) {
  const double d0 = m(0, 0), i0 = 1 / d0;
  const double l10 = m(0, 1) * i0, l20 = m(0, 2) * i0;
  const double d1 = std::max(m(1, 1) - l10 * m(0, 1), kRounding * m(1, 1)), i1 = 1 / d1;
  const double u12 = m(1, 2) - l10 * m(0, 2), l21 = u12 * i1;
  const double d2 = std::max(m(2, 2) - l20 * m(0, 2) - l21 * u12, kRounding * m(2, 2)), i2 = 1 / d2;
  const double m20 = l10 * l21 - l20;  // the last row of L^-1 is (m20, -l21, 1)
  const double r01 = -l10 * i1 - l21 * m20 * i2, r02 = m20 * i2, r12 = -l21 * i2;
  Mat3 r;
  r << i0 + l10 * l10 * i1 + m20 * m20 * i2, r01, r02, r01, i1 + l21 * l21 * i2, r12, r02, r12, i2;
  return r;
}

/// The cross products of `v` with the columns of `m`: [v]x m.
inline Mat3 cross_columns(const Vec3& v, const Mat3& m) {
  Mat3 r;
  for (int i = 0; i < 3; ++i) r.col(i) = v.cross(Vec3(m.col(i)));
  return r;
}

/// The rotation I + [v]x + ... by Cayley's map: exactly orthogonal, and by |v| for a short v.
inline Mat3 cayley(const Vec3& v) {
  const Vec3 w = 0.5 * v;
  const double ww = w.squaredNorm(), f = 2 / (1 + ww);
  Mat3 r = f * (w * w.transpose());
  r.diagonal().array() += 1 - f * ww;
  const Vec3 s = f * w;
  r(0, 1) -= s.z(), r(1, 0) += s.z();
  r(0, 2) += s.y(), r(2, 0) -= s.y();
  r(1, 2) -= s.x(), r(2, 1) += s.x();
  return r;
}

/// Removes rounding errors from a nearly orthonormal frame.
inline void sharpen(Mat3& frame) { frame = 1.5 * frame - 0.5 * product(frame, transposed_product(frame, frame)); }

/// Axis times sine of the rotation from frame `a` to frame `b`.
inline Vec3 turned_by(const Mat3& a, const Mat3& b) {
  return 0.5 * (a.col(0).cross(b.col(0)) + a.col(1).cross(b.col(1)) + a.col(2).cross(b.col(2)));
}

}  // namespace vmesh
