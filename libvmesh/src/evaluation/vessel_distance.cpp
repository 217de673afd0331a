#include "vmesh/evaluation/vessel_distance.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include "vmesh/quality/sampled_distance.h"

namespace vmesh {
namespace {

constexpr std::size_t kReportEvery = 4096, kMeasuredTogether = 16384, kPerTask = 256;  // samples

// Collects the distances of samples.
class SideCollector {
 public:
  SideCollector(std::size_t count, const Progress& progress) : count_(count), progress_(progress) {
    mm_.reserve(count);
    relative_.reserve(count);
  }

  void add(const Vec3& position, double distance, double radius) {
    if (mm_.size() % kReportEvery == 0) {
      report_progress(progress_, "distance from the volume",
                      static_cast<double>(mm_.size()) / static_cast<double>(count_));
    }
    if (distance > max_) max_ = distance, side_.max_at = position;
    if (distance / radius > max_relative_) max_relative_ = distance / radius, side_.max_relative_at = position;
    mm_.push_back(distance);
    relative_.push_back(distance / radius);
  }

  VesselDistanceSide finish(double samples_per_mm2) {
    side_.samples_per_mm2 = samples_per_mm2;
    side_.mm = summarize(std::move(mm_));
    side_.relative = summarize(std::move(relative_));
    return side_;
  }

 private:
  std::size_t count_;
  const Progress& progress_;
  std::vector<double> mm_, relative_;
  double max_ = -1, max_relative_ = -1;
  VesselDistanceSide side_;
};

struct Measured {
  Vec3 position;
  double distance, radius;
};

// Adds measure(i, near) for all i in order, a batch at a time; `near` is passed on from one to the next within a task,
// which are the same for any number of threads.
template <class Measure>
void measure_in_order(std::size_t count, SideCollector& to, const Measure& measure) {
  std::vector<Measured> batch(std::min(count, kMeasuredTogether));
  for (std::size_t first = 0; first < count; first += kMeasuredTogether) {
    const std::size_t size = std::min(kMeasuredTogether, count - first);
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, size, kPerTask),
        [&](const auto& range) {
          Index near = kNone;
          for (std::size_t i = range.begin(); i < range.end(); ++i) batch[i] = measure(first + i, near);
        },
        tbb::simple_partitioner());
    for (std::size_t i = 0; i < size; ++i) to.add(batch[i].position, batch[i].distance, batch[i].radius);
  }
}

}  // namespace

VesselDistance measure_vessel_distance(const TriMesh& mesh, const ClosestPointIndex& index, const VesselField& field,
                                       std::size_t samples, const Progress& progress) {
  VesselDistance result;
  const std::vector<SurfaceSample> on_mesh = sample_surface(mesh, samples);
  SideCollector from_mesh(on_mesh.size(), progress);
  measure_in_order(on_mesh.size(), from_mesh, [&](std::size_t i, Index&) {
    const FieldSample found = field.sample_global(on_mesh[i].position);
    return Measured{on_mesh[i].position, std::abs(found.distance), field.relations().radius_at(found.cone, found.t)};
  });
  result.from_mesh = from_mesh.finish(on_mesh.empty() ? 0 : static_cast<double>(on_mesh.size()) / surface_area(mesh));

  const BoundarySamples on_volume = sample_boundary(field, samples);
  SideCollector from_volume(on_volume.points.size(), progress);
  measure_in_order(on_volume.points.size(), from_volume, [&](std::size_t i, Index& near) {
    const BoundarySample& sample = on_volume.points[i];
    const ClosestPoint found = index.closest(sample.position, near);
    near = found.face;
    return Measured{sample.position, found.distance, sample.radius};
  });
  result.from_volume = from_volume.finish(on_volume.per_mm2);
  return result;
}

std::vector<double> vertex_vessel_distances(const TriMesh& mesh, const VesselField& field) {
  std::vector<double> distances(mesh.vertices.size());
  tbb::parallel_for(std::size_t{0}, distances.size(),
                    [&](std::size_t v) { distances[v] = field.sample_global(mesh.vertices[v]).distance; });
  return distances;
}

}  // namespace vmesh
