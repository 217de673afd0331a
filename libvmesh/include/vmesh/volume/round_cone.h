#pragma once

#include <algorithm>
#include <cmath>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// The convex hull of two spheres, with what its distance needs.
struct RoundCone {
  Vec3 origin = Vec3::Zero(), axis = Vec3::Zero();  ///< axis = last - first, mm
  double r0 = 0, r1 = 0;                            ///< mm
  double inv_length2 = 0;                           ///< 1 / |axis|^2; 0 for a sphere
  double lag = 0;                ///< tan(half angle) / |axis|: how far the touching sphere lags the foot point
  double t_low = 0, t_high = 1;  ///< equal where one end sphere contains the other

  RoundCone() = default;
  RoundCone(const CenterlineNode& first, const CenterlineNode& last)
      : origin(first.position), axis(last.position - first.position), r0(first.radius), r1(last.radius) {
    const double length = axis.norm();
    if (length > 0) inv_length2 = 1 / (length * length);
    if (std::abs(r0 - r1) >= length) {
      t_low = t_high = r0 >= r1 ? 0 : 1;
    } else {
      const double sine = (r0 - r1) / length;
      lag = sine / std::sqrt(1 - sine * sine) / length;
    }
  }

  struct Distance {
    double value;  ///< signed, mm; negative inside
    double t;      ///< parameter on the axis of the sphere that touches the boundary there, in [0, 1]
  };
  /// Exact. The closest of the spheres that sweep the cone: its centre is where the normal of the lateral surface
  /// through p meets the axis, clamped to the axis.
  Distance distance_to(const Vec3& p) const {
    const Vec3 q = p - origin;
    const double foot = q.dot(axis) * inv_length2;
    const double off_axis = (q - foot * axis).norm();
    const double t = std::clamp(foot - off_axis * lag, t_low, t_high);
    return {(q - t * axis).norm() - (r0 + t * (r1 - r0)), t};
  }
  /// Of the distance, given distance_to(p).t; zero on the axis.
  Vec3 gradient(const Vec3& p, double t) const {
    const Vec3 away = p - origin - t * axis;
    const double norm = away.norm();
    return norm > 0 ? Vec3(away / norm) : Vec3(Vec3::Zero());
  }
  double radius_at(double t) const { return r0 + t * (r1 - r0); }
};

}  // namespace vmesh
