#include "surface/junction/junction_threads.h"

#include <optional>

namespace vmesh {
namespace {

constexpr double kThinnest =
    0.6;                        // lattice spacings: as measured, narrower openings fold when they dock at the lattice
constexpr double kStep = 0.25;  // radii, of a walk along the axis
constexpr double kDirection = 0.6;  // radii before and behind over which the direction of the vessel is taken

double end_of(const Gap& gap, bool at_end) { return at_end ? gap.end : gap.begin; }

// Walks inwards from the opening until the axis is so deep below a wall that neither the vessel nor its blend reaches
// that any more.
std::optional<double> find_root(const VesselField& volume, Index cone, const BranchAxis& axis, const Gap& gap,
                                bool at_end) {
  const double deep = 1 + 2 * volume.blend();  // radii
  for (double place = end_of(gap, at_end);;) {
    const auto point = axis.at(place);
    const double step = kStep * point.radius;
    if (std::abs(place - end_of(gap, !at_end)) <= step) return std::nullopt;
    const FieldSample sample = volume.sample(point.position, cone);
    if (sample.distance < -deep * point.radius) return place;
    cone = sample.cone;
    place += at_end ? -step : step;
  }
}

}  // namespace

std::vector<Thread> narrow_openings(const std::vector<BranchAxis>& axes, const Junction& junction, double spacing) {
  std::vector<Thread> narrow;
  for (Index g = 0; g < junction.gaps.size(); ++g) {
    const Gap& gap = junction.gaps[g];
    for (const bool at_end : {false, true}) {
      if (gap.openings[at_end].tube == kNone || gap.openings[!at_end].tube != kNone) continue;
      if (axes[gap.branch].at(end_of(gap, at_end)).radius < kThinnest * spacing) narrow.push_back({g, at_end, 0, {}});
    }
  }
  return narrow;
}

std::vector<Thread> find_threads(const std::vector<Thread>& narrow, const VesselField& volume,
                                 const JunctionCenterline& local, const std::vector<BranchAxis>& axes,
                                 const Junction& junction) {
  std::vector<Thread> threads;
  for (Thread thread : narrow) {
    const Gap& gap = junction.gaps[thread.gap];
    const Index cone = local.end_segment(thread.gap, thread.at_end);
    const auto root = find_root(volume, cone, axes[gap.branch], gap, thread.at_end);
    if (!root) continue;
    thread.root = *root;
    threads.push_back(thread);
  }
  return threads;
}

Junction without_threads(Junction junction, const std::vector<Thread>& threads) {
  for (const Thread& thread : threads) {
    Gap& gap = junction.gaps[thread.gap];
    (thread.at_end ? gap.end : gap.begin) = thread.root;
  }
  return junction;
}

CrossSection find_exit(const Thread& thread, const BranchAxis& axis, const Gap& gap, const VesselField& rest,
                       Index stub) {
  const double way = thread.at_end ? 1 : -1, length = std::abs(end_of(gap, thread.at_end) - thread.root);
  auto point = axis.at(thread.root);
  double walked = 0;
  while (walked < length && rest.sample(point.position, stub).distance < 0) {
    walked = std::min(length, walked + kStep * point.radius);
    point = axis.at(thread.root + way * walked);
  }
  const double place = thread.root + way * walked;
  return {place, point.position, way * axis.direction(place, kDirection * point.radius), point.radius};
}

}  // namespace vmesh
