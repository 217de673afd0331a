#pragma once

#include <cmath>

#include "vmesh/core/types.h"
#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {

/// A metric in which triangles that are longer along a vessel than around it are equilateral: I - w w^T, the identity
/// where w is zero. Along w lengths count 1 / times of what they are, with |w|^2 = 1 - 1 / times^2.
class ElongatedMetric {
 public:
  explicit ElongatedMetric(const Vec3& w) : w_(w) {
    const double w2 = w.squaredNorm();
    if (w2 == 0) return;
    const double shrink = std::sqrt(1 - w2);
    forth_ = (1 - shrink) / w2;
    back_ = (1 / shrink - 1) / w2;
  }

  /// Whether it is the metric of space.
  bool is_plain() const { return forth_ == 0; }
  /// To where the metric is that of space, and back.
  Vec3 shrunk(const Vec3& way) const { return way - forth_ * w_.dot(way) * w_; }
  Vec3 stretched(const Vec3& way) const { return way + back_ * w_.dot(way) * w_; }
  /// The way as long as the metric says.
  double length(const Vec3& way) const {
    const double along = w_.dot(way);
    return std::sqrt(way.squaredNorm() - along * along);
  }

  /// Equiangle skewness of a triangle in the metric.
  double skewness(const Vec3& a, const Vec3& b, const Vec3& c) const {
    if (is_plain()) return equiangle_skewness(a, b, c);
    return equiangle_skewness(Vec3::Zero(), shrunk(b - a), shrunk(c - a));
  }

  static Vec3 vector(const Vec3& direction, double times) {
    return times > 1 ? Vec3(std::sqrt(1 - 1 / (times * times)) * direction) : Vec3(Vec3::Zero());
  }

 private:
  Vec3 w_;
  double forth_ = 0, back_ = 0;
};

/// How much longer than wide triangles may be on a vessel, and which way.
struct Elongation {
  double times = 1;
  Vec3 direction = Vec3::Zero();  ///< unit, along the vessel; zero where times is 1

  Vec3 metric() const { return ElongatedMetric::vector(direction, times); }
};

/// The elongation at every place of the vessels.
class ElongationField {
 public:
  virtual ~ElongationField() = default;
  /// On the cone, at parameter `t` of its axis.
  virtual Elongation elongation_at(Index cone, double t) const = 0;
};

}  // namespace vmesh
