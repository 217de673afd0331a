#include "vmesh/quality/sampled_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "vmesh/core/error.h"

#include "quality/triangle_tree.h"

namespace vmesh {
namespace {

// The plastic number, the analogue of the golden ratio in two dimensions.
constexpr double kPlastic = 1.32471795724474602596;
constexpr std::size_t kBatch = 16384, kTogether = 256;  // samples

// A point of the unit square, folded along its diagonal onto the triangle.
Vec3 place_in(const TriMesh& mesh, Index face, double number) {
  double u = std::fmod(0.5 + number / kPlastic, 1), v = std::fmod(0.5 + number / (kPlastic * kPlastic), 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  const auto& [a, b, c] = mesh.faces[face];
  return (1 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c];
}

}  // namespace

double surface_area(const TriMesh& mesh) {
  double twice = 0;
  for (Index f = 0; f < mesh.faces.size(); ++f) twice += area_normal(mesh, f).norm();
  return twice / 2;
}

std::vector<SurfaceSample> sample_surface(const TriMesh& mesh, std::size_t count) {
  std::vector<SurfaceSample> samples;
  if (mesh.faces.empty()) return samples;
  measure_extent(mesh);  // for its checks
  const double step = surface_area(mesh) / static_cast<double>(count);
  if (!(step > 0)) return samples;
  samples.reserve(count);
  double area = 0;  // of the faces so far
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    area += area_normal(mesh, f).norm() / 2;
    for (; samples.size() < count;) {
      const double number = static_cast<double>(samples.size());
      if ((number + 0.5) * step > area) break;
      samples.push_back({place_in(mesh, f, number), f});
    }
  }
  return samples;
}

SampledDistance sample_distance(const TriMesh& from, const ClosestPointIndex& to, std::size_t samples,
                                const Progress& progress) {
  const std::vector<SurfaceSample> points = sample_surface(from, samples);
  std::vector<double> distances(points.size());
  for (std::size_t first = 0; first < points.size(); first += kBatch) {
    report_progress(progress, "samples", static_cast<double>(first) / static_cast<double>(points.size()));
    const std::size_t last = std::min(points.size(), first + kBatch);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(first, last, kTogether),
        [&](const auto& range) {
          Index near = kNone;
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const ClosestPoint found = to.closest(points[i].position, near);
            near = found.face;
            distances[i] = found.distance;
          }
        },
        tbb::simple_partitioner());
  }
  const double area = surface_area(from);
  const double density = area > 0 ? static_cast<double>(distances.size()) / area : 0;
  return {summarize(std::move(distances)), density};
}

std::vector<double> vertex_distances(const TriMesh& from, const ClosestPointIndex& to) {
  std::vector<double> distances(from.vertices.size(), std::numeric_limits<double>::quiet_NaN());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, distances.size(), kTogether),
      [&](const auto& range) {
        Index near = kNone;
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
          if (!within_reach(from.vertices[v])) continue;
          const ClosestPoint found = to.closest(from.vertices[v], near);
          near = found.face;
          distances[v] = found.distance;
        }
      },
      tbb::simple_partitioner());
  return distances;
}

}  // namespace vmesh
