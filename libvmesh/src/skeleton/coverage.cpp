#include "coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

// A point of the wall is covered if the vessels' boundary is nearer than this times the radius, or this number of
// voxels.
constexpr double kReachRadii = 0.5, kReachVoxels = 1.5;
// Missed samples in neighbouring cells are one region; the cells' size in spacings of samples.
constexpr double kCellSpacings = 3;

/// A point of the wall and how far it is from the vessels' boundary.
struct Deviation {
  double distance, area;
  Vec3 point;
};

WallDistance summarized(std::vector<Deviation> deviations) {
  WallDistance wall;
  if (deviations.empty()) return wall;
  std::sort(deviations.begin(), deviations.end(),
            [](const Deviation& a, const Deviation& b) { return a.distance < b.distance; });
  for (const Deviation& d : deviations) {
    wall.area += d.area;
    wall.mean += d.area * d.distance;
  }
  if (wall.area > 0) wall.mean /= wall.area;
  wall.max = deviations.back().distance;
  wall.max_at = deviations.back().point;
  double below = 0;
  for (const Deviation& d : deviations) {
    wall.percentile_95 = d.distance;
    if ((below += d.area) >= 0.95 * wall.area) break;
  }
  return wall;
}

Graph graph_of(const Centerline& centerline) {
  Graph graph;
  for (const CenterlineNode& node : centerline.nodes()) graph.nodes.push_back({node.position, node.radius});
  for (const CenterlineSegment& segment : centerline.segments()) graph.edges.push_back({segment.a, segment.b});
  return graph;
}

struct Missed {
  std::size_t sample;
  double distance;
};

/// Regions of missed samples that lie next to each other.
std::vector<MissedWall> regions_of(const std::vector<Missed>& missed, const FitSamples& samples,
                                   const std::vector<bool>& left_out) {
  if (missed.empty()) return {};
  double area = 0;
  for (const Missed& m : missed) area += samples.areas[m.sample];
  const double cell = kCellSpacings * std::sqrt(area / static_cast<double>(missed.size()));
  using Cell = std::array<long, 3>;
  std::map<Cell, Index> first_in;  // in missed
  DisjointSets sets(missed.size());
  const auto cell_of = [&](std::size_t sample) {
    const Vec3 at = samples.points[sample] / cell;
    return Cell{std::lround(std::floor(at.x())), std::lround(std::floor(at.y())), std::lround(std::floor(at.z()))};
  };
  for (Index i = 0; i < missed.size(); ++i) {
    const Cell at = cell_of(missed[i].sample);
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long z = -1; z <= 1; ++z)
          if (const auto found = first_in.find({at[0] + x, at[1] + y, at[2] + z}); found != first_in.end())
            sets.join(found->second, i);
    first_in.try_emplace(at, i);
  }
  std::map<Index, MissedWall> regions;
  std::map<Index, double> left_out_area;
  for (Index i = 0; i < missed.size(); ++i) {
    const auto [sample, distance] = missed[i];
    MissedWall& region = regions[sets.find(i)];
    region.area += samples.areas[sample];
    if (distance > region.distance) region.distance = distance, region.place = samples.points[sample];
    if (left_out[sample]) left_out_area[sets.find(i)] += samples.areas[sample];
  }
  std::vector<MissedWall> list;
  for (auto& [first, region] : regions) {
    region.reason = left_out_area[first] > 0.5 * region.area ? "a component that was left out"
                                                             : "wider than round vessels, or between them";
    list.push_back(std::move(region));
  }
  std::stable_sort(list.begin(), list.end(), [](const MissedWall& a, const MissedWall& b) { return a.area > b.area; });
  return list;
}

}  // namespace

void measure_coverage(const Centerline& centerline, const FitSamples& samples, const std::vector<bool>& left_out,
                      double voxel, ExtractionReport& report) {
  const GraphCones cones(graph_of(centerline));
  const std::vector<GraphCones::Place> places = cones.closest(samples.points);
  const std::vector<Branch> branches = find_branches(centerline);
  std::vector<std::size_t> branch_of(std::max<std::size_t>(cones.size(), 1), branches.size());  // isolated: none
  for (std::size_t b = 0; b < branches.size(); ++b)
    for (const Index segment : branches[b].segments) branch_of[segment] = b;
  std::vector<Deviation> all;
  std::vector<std::vector<Deviation>> of_branch(branches.size() + 1);
  std::vector<Missed> missed;
  double area = 0, covered = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double distance = std::abs(places[i].distance);
    const double reach = std::max(kReachRadii * cones.radius_at(places[i]), kReachVoxels * voxel);
    area += samples.areas[i];
    if (distance <= reach) {
      covered += samples.areas[i];
    } else {
      missed.push_back({i, distance});
    }
    if (left_out[i]) continue;
    all.push_back({distance, samples.areas[i], samples.points[i]});
    of_branch[branch_of[places[i].cone]].push_back(all.back());
  }
  of_branch.pop_back();
  report.branches.clear();
  for (std::vector<Deviation>& deviations : of_branch) report.branches.push_back(summarized(std::move(deviations)));
  report.wall = summarized(std::move(all));
  report.coverage = area > 0 ? covered / area : 1;
  report.missed = regions_of(missed, samples, left_out);
}

}  // namespace vmesh::skeleton
