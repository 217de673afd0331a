#include "vmesh/quality/hausdorff.h"

#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>

#include <tbb/parallel_invoke.h>

#include "vmesh/core/error.h"

#include "quality/hausdorff_search.h"

namespace vmesh {
namespace {

// Margin for the rounding of a distance, relative to coordinates and extents: a few dozen roundings of 2^-53 each.
constexpr double kRounding = 0x1p-46;
constexpr double kFinestTolerance = 0x1p-40;

double size_of(const Extent& a, const Extent& b) {
  return std::max(a.magnitude(), b.magnitude()) + a.diagonal() + b.diagonal();
}

void check_tolerance(double tolerance, double size) {
  if (!(tolerance > 0)) throw InvalidInput("the tolerance of a Hausdorff distance must be larger than 0");
  if (tolerance < kFinestTolerance * size) {
    std::ostringstream text;
    text << "a tolerance of " << tolerance
         << " mm is finer than double precision can resolve for meshes of this size and "
         << "distance from the origin; ask for " << kFinestTolerance * size << " mm or more";
    throw InvalidInput(text.str());
  }
}

constexpr double kNoStart = -1;

class Measurement {
 public:
  Measurement(const TriMesh& from, const Extent& from_extent, const TriangleTree& to, const HausdorffOptions& options)
      : from_(from), to_(to), options_(options), room_(kRounding * size_of(from_extent, to.extent())) {
    check_tolerance(options.tolerance, room_ / kRounding);
  }

  HausdorffSearch search(double start, bool stop_above_start) const {
    HausdorffSearch search(from_, to_, {options_.tolerance - 2 * room_, start, stop_above_start}, options_.progress);
    search.run();
    return search;
  }

  OneSidedHausdorff distance() const {
    const HausdorffSearch found = search(kNoStart, false);
    return {std::max(0.0, found.lower() - room_), found.upper() + room_, *witness(found)};
  }

  double room() const { return room_; }

  std::optional<DistanceWitness> witness(const HausdorffSearch& found) const {
    if (!found.farthest()) return std::nullopt;
    const auto& [position, nearest] = *found.farthest();
    return DistanceWitness{position, found.farthest_face(), to_.frame(nearest.face).closest(position), nearest.face};
  }

 private:
  const TriMesh& from_;
  const TriangleTree& to_;
  const HausdorffOptions& options_;
  double room_;  // for rounding, mm
};

}  // namespace

OneSidedHausdorff one_sided_hausdorff(const TriMesh& from, const TriMesh& to, const HausdorffOptions& options) {
  const Extent extent = measure_extent(from);
  return Measurement(from, extent, TriangleTree(to), options).distance();
}

Hausdorff hausdorff(const TriMesh& a, const TriMesh& b, const HausdorffOptions& options) {
  std::optional<TriangleTree> first, second;
  tbb::parallel_invoke([&] { first.emplace(a); }, [&] { second.emplace(b); });
  std::mutex reporting;
  HausdorffOptions one_at_a_time = options;
  if (options.progress) {
    one_at_a_time.progress = [&](std::string_view stage, double fraction) {
      const std::lock_guard lock(reporting);
      return options.progress(stage, fraction);
    };
  }
  Hausdorff result;
  tbb::parallel_invoke([&] { result.forward = Measurement(a, first->extent(), *second, one_at_a_time).distance(); },
                       [&] { result.backward = Measurement(b, second->extent(), *first, one_at_a_time).distance(); });
  return result;
}

SymmetricHausdorff symmetric_hausdorff(const TriMesh& a, const TriMesh& b, const HausdorffOptions& options) {
  const TriangleTree first(a), second(b);
  const OneSidedHausdorff forward = Measurement(a, first.extent(), second, options).distance();
  const Measurement backward(b, second.extent(), first, options);
  const HausdorffSearch found = backward.search(forward.lower, false);
  const double upper = std::max(forward.upper, found.upper() + backward.room());
  const std::optional<DistanceWitness> witness = backward.witness(found);
  if (!witness) return {forward.lower, upper, forward.witness, false};
  return {std::max(forward.lower, found.lower() - backward.room()), upper, *witness, true};
}

std::optional<DistanceWitness> hausdorff_exceeds(const TriMesh& from, const TriMesh& to, double limit,
                                                 const HausdorffOptions& options) {
  if (!(limit >= 0) || std::isinf(limit))
    throw InvalidInput("a distance to compare with must be finite and at least 0");
  const Extent extent = measure_extent(from);
  const TriangleTree tree(to);
  const Measurement measurement(from, extent, tree, options);
  return measurement.witness(measurement.search(limit + measurement.room(), true));
}

}  // namespace vmesh
