#include "vmesh/surface/deviation.h"

#include <cmath>

#include "surface/remesh/bound_surface.h"

namespace vmesh {
namespace {

constexpr double kSampleWeights[4][3] = {
    {1.0 / 3, 1.0 / 3, 1.0 / 3}, {2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}};

// Gathers the absolute value of what distance_at(point, hint) says at the sample points.
template <class DistanceAt>
Deviation gather(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const VesselField& field,
                 DistanceAt&& distance_at) {
  Deviation deviation;
  double total_area = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const double area = area_normal(mesh, f).norm();
    total_area += 4 * area;
    for (const auto& weight : kSampleWeights) {
      Vec3 p = Vec3::Zero();
      for (int i = 0; i < 3; ++i) p += weight[i] * mesh.vertices[mesh.faces[f][i]];
      const FieldSample sample = distance_at(p, binding[mesh.faces[f][0]].segment);
      const double distance = std::abs(sample.distance);
      const double relative = distance / field.radius_at(sample.cone, sample.t);
      deviation.mean_mm += area * distance;
      deviation.rms_mm += area * distance * distance;
      deviation.mean_relative += area * relative;
      deviation.rms_relative += area * relative * relative;
      deviation.max_mm = std::max(deviation.max_mm, distance);
      if (relative > deviation.max_relative) {
        deviation.max_relative = relative;
        deviation.max_at = p;
      }
    }
  }
  if (total_area > 0) {
    deviation.mean_mm /= total_area;
    deviation.rms_mm = std::sqrt(deviation.rms_mm / total_area);
    deviation.mean_relative /= total_area;
    deviation.rms_relative = std::sqrt(deviation.rms_relative / total_area);
  }
  return deviation;
}

}  // namespace

Deviation measure_deviation(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                            const VesselField& field) {
  return gather(mesh, binding, field, [&field](const Vec3& p, Index hint) { return field.sample(p, hint); });
}

Deviation measure_rounding(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                           const VesselField& rounded, const VesselField& plain) {
  return gather(mesh, binding, plain, [&](const Vec3& p, Index hint) {
    const BoundaryPoint point = project_to_boundary(rounded, p, hint);
    return plain.sample(point.position, point.sample.cone);
  });
}

}  // namespace vmesh
