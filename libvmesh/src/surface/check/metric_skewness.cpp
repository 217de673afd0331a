#include "vmesh/surface/metric_skewness.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "vmesh/mesh/triangle_quality.h"

#include "surface/remesh/least_skewness.h"

namespace vmesh {
namespace {

// Directions have no sign: they are added so that the sum is longest, whatever their order.
Elongation mean_of(const std::array<Elongation, 3>& corners) {
  const auto& [a, b, c] = corners;
  Elongation mean;
  mean.times = std::max({a.times, b.times, c.times});
  double longest = 0;
  for (const double of_b : {-1.0, 1.0}) {
    for (const double of_c : {-1.0, 1.0}) {
      const Vec3 sum = a.direction + of_b * b.direction + of_c * c.direction;
      if (sum.squaredNorm() <= longest) continue;
      longest = sum.squaredNorm();
      mean.direction = sum;
    }
  }
  if (longest == 0) return {};
  mean.direction /= std::sqrt(longest);
  return mean;
}

Elongation from_vector(const Vec3& elongation) {
  const double times = elongation.norm();
  if (times <= 1) return {};
  return {times, elongation / times};
}

}  // namespace

double least_skewness(const std::array<Vec3, 3>& p, const std::array<Elongation, 3>& corners) {
  const double plain = equiangle_skewness(p[0], p[1], p[2]);
  const Elongation allowed = mean_of(corners);
  if (allowed.times <= 1) return plain;
  // Divided by k along the direction, the squares across stay and those along shrink by k^2, the area by k.
  double along = 0, across = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = p[(i + 1) % 3] - p[i];
    const double part = edge.dot(allowed.direction);
    along += part * part;
    across += edge.squaredNorm() - part * part;
  }
  const double times = std::sqrt(along / std::max(across, along / (allowed.times * allowed.times)));
  if (!(times > 1)) return plain;
  const ElongatedMetric metric(ElongatedMetric::vector(allowed.direction, times));
  return std::min(plain, metric.skewness(p[0], p[1], p[2]));
}

double metric_skewness(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& elongation) {
  if (std::all_of(elongation.begin(), elongation.end(), [](const Vec3& e) { return e.isZero(0); }))
    return equiangle_skewness(corners[0], corners[1], corners[2]);
  return least_skewness(corners, {from_vector(elongation[0]), from_vector(elongation[1]), from_vector(elongation[2])});
}

std::vector<double> metric_skewness(const TriMesh& mesh, const std::vector<Vec3>& elongation) {
  if (elongation.empty()) return equiangle_skewness(mesh);
  const auto at = [&](Index v) { return v < elongation.size() ? elongation[v] : Vec3(Vec3::Zero()); };
  std::vector<double> skewness(mesh.faces.size());
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, skewness.size(), [&](std::size_t f) {
      const auto& [a, b, c] = mesh.faces[f];
      skewness[f] = metric_skewness({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, {at(a), at(b), at(c)});
    });
  });
  return skewness;
}

}  // namespace vmesh
