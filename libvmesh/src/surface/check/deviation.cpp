#include "vmesh/surface/deviation.h"

#include <array>
#include <cmath>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "surface/remesh/bound_surface.h"

namespace vmesh {
namespace {

constexpr double kSampleWeights[4][3] = {
    {1.0 / 3, 1.0 / 3, 1.0 / 3}, {2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}};

constexpr std::size_t kBatch = 1 << 14;  // faces sampled before they are summed up

struct Sample {
  Vec3 point;
  double distance, relative;
};
using FaceSamples = std::array<Sample, 4>;

template <class DistanceAt>
FaceSamples samples_of(const TriMesh& mesh, Index f, Index hint, const VesselField& field,
                       const DistanceAt& distance_at) {
  FaceSamples samples;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < 3; ++i) p += kSampleWeights[k][i] * mesh.vertices[mesh.faces[f][i]];
    const FieldSample sample = distance_at(p, hint);
    const double distance = std::abs(sample.distance);
    samples[k] = {p, distance, distance / field.relations().radius_at(sample.cone, sample.t)};
  }
  return samples;
}

void add(Deviation& deviation, double area, const FaceSamples& samples) {
  for (const auto& [point, distance, relative] : samples) {
    deviation.mean_mm += area * distance;
    deviation.rms_mm += area * distance * distance;
    deviation.mean_relative += area * relative;
    deviation.rms_relative += area * relative * relative;
    deviation.max_mm = std::max(deviation.max_mm, distance);
    if (relative > deviation.max_relative) {
      deviation.max_relative = relative;
      deviation.max_at = point;
    }
  }
}

// Gathers |distance_at(point, hint)| at the sample points. Sums are taken in the order of the faces, whichever thread
// samples them.
template <class DistanceAt>
Deviation gather(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding, const VesselField& field,
                 int threads, const DistanceAt& distance_at) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  Deviation deviation;
  double total_area = 0;
  std::vector<FaceSamples> samples(std::min(kBatch, mesh.faces.size()));
  for (std::size_t first = 0; first < mesh.faces.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, mesh.faces.size() - first);
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const auto f = static_cast<Index>(first + i);
        samples[i] = samples_of(mesh, f, binding[mesh.faces[f][0]].segment, field, distance_at);
      });
    });
    for (std::size_t i = 0; i < count; ++i) {
      const double area = area_normal(mesh, static_cast<Index>(first + i)).norm();
      total_area += 4 * area;
      add(deviation, area, samples[i]);
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
                            const VesselField& field, int threads) {
  return gather(mesh, binding, field, threads,
                [&field](const Vec3& p, Index hint) { return field.sample_fast(p, hint); });
}

Deviation measure_rounding(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                           const VesselField& rounded, int threads) {
  return gather(mesh, binding, rounded, threads, [&](const Vec3& p, Index hint) {
    const BoundaryPoint point = project_to_boundary(rounded, p, hint);
    return rounded.sample_cone(point.position, point.sample.cone);
  });
}

}  // namespace vmesh
