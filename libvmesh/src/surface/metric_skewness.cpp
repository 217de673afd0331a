#include "vmesh/surface/metric_skewness.h"

#include <algorithm>
#include <cmath>

#include "vmesh/mesh/triangle_quality.h"

#include "surface/remesh/elongated_metric.h"

namespace vmesh {
namespace {

// From one factor that is tried to the next, about. An angle changes by as much at most.
constexpr double kFactor = 1.1;

double least_skewness(const std::array<Vec3, 3>& p, const Elongation& allowed) {
  double least = equiangle_skewness(p[0], p[1], p[2]);
  const int tries = allowed.times > 1 ? static_cast<int>(std::ceil(std::log(allowed.times) / std::log(kFactor))) : 0;
  for (int i = 1; i <= tries; ++i) {
    const ElongatedMetric metric(
        ElongatedMetric::vector(allowed.direction, std::pow(allowed.times, double(i) / double(tries))));
    least = std::min(least, metric.skewness(p[0], p[1], p[2]));
  }
  return least;
}

}  // namespace

std::vector<double> metric_skewness(const TriMesh& mesh, const std::vector<Vec3>& elongation) {
  if (elongation.empty()) return equiangle_skewness(mesh);
  std::vector<double> skewness;
  skewness.reserve(mesh.faces.size());
  for (const Triangle& f : mesh.faces) {
    Elongation allowed;
    std::array<Vec3, 3> p;
    for (int i = 0; i < 3; ++i) {
      p[i] = mesh.vertices[f[i]];
      if (f[i] >= elongation.size()) continue;
      const double times = elongation[f[i]].norm();
      if (times <= allowed.times) continue;
      allowed = {times, elongation[f[i]] / times};
    }
    skewness.push_back(least_skewness(p, allowed));
  }
  return skewness;
}

}  // namespace vmesh
