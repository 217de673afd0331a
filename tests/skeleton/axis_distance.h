#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh::testing {

/// Distances of points of one axis from another one, in radii of the latter.
struct AxisComparison {
  double mean_distance = 0, distance_95 = 0, max_distance = 0;
  double mean_radius_error = 0, radius_error_95 = 0;  ///< absolute, in true radii
  double radius_bias = 0;                             ///< mean of the signed error
};

struct AxisPoint {
  Vec3 position;
  double radius;
};

/// Points at most a quarter of a radius apart.
inline std::vector<AxisPoint> points_of(const Centerline& centerline) {
  std::vector<AxisPoint> points;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const int count = 1 + static_cast<int>(4 * centerline.length(s) / centerline.radius_at(s, 0.5));
    for (int i = 0; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      points.push_back({centerline.point_at(s, t), centerline.radius_at(s, t)});
    }
  }
  return points;
}

/// The nearest point of the axis of `centerline`.
inline AxisPoint nearest(const Centerline& centerline, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  AxisPoint point{};
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const Vec3 a = centerline.point_at(s, 0), axis = centerline.point_at(s, 1) - a;
    const double t = std::clamp((p - a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    const double distance = (p - a - t * axis).norm();
    if (distance < best) best = distance, point = {a + t * axis, centerline.radius_at(s, t)};
  }
  return point;
}

/// Distances of the points of `axis` from the axis of `truth`.
inline AxisComparison compare(const Centerline& axis, const Centerline& truth) {
  std::vector<double> distances, errors;
  AxisComparison result;
  for (const AxisPoint& point : points_of(axis)) {
    const AxisPoint near = nearest(truth, point.position);
    distances.push_back((point.position - near.position).norm() / near.radius);
    errors.push_back(std::abs(point.radius - near.radius) / near.radius);
    result.radius_bias += (point.radius - near.radius) / near.radius;
  }
  const auto count = static_cast<double>(distances.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    result.mean_distance += distances[i] / count;
    result.mean_radius_error += errors[i] / count;
  }
  result.radius_bias /= count;
  std::sort(distances.begin(), distances.end());
  std::sort(errors.begin(), errors.end());
  const auto at_95 = static_cast<std::size_t>(0.95 * count);
  result.distance_95 = distances[at_95];
  result.max_distance = distances.back();
  result.radius_error_95 = errors[at_95];
  return result;
}

inline std::size_t end_count(const Centerline& centerline) {
  std::size_t count = 0;
  for (Index n = 0; n < centerline.nodes().size(); ++n) count += centerline.degree(n) == 1 ? 1 : 0;
  return count;
}

}  // namespace vmesh::testing
