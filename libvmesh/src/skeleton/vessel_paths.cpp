#include "vessel_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>

#include "front_graph.h"

namespace vmesh::skeleton {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
// A voxel is near a path within this times the depth there plus this number of voxels, which a rough boundary needs.
constexpr double kNearDepths = 1.2, kNearVoxels = 2;
// Fronts that meet again sooner are a tunnel in a rough boundary, or a notch: sooner than these
// numbers of depths, and of voxels.
constexpr double kLoopDepths = 1, kLoopVoxels = 5, kLoopSlices = 3;
constexpr std::size_t kBetweenReports = 1000;  // voxels
constexpr float kOnPath = 1e-3f;               // of the cost of other voxels: a second path prefers the first one's way

// A path around a loop may go this number of depths, and this share of the loop, beyond where its sides meet.
constexpr double kBeyondDepths = 4, kBeyond = 0.5;

using Entry = std::pair<float, Index>;
using NearestFirst = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

class PathFinder {
 public:
  PathFinder(const VoxelGraph& graph, const std::vector<float>& depth, const std::vector<float>& occupancy)
      : graph_(graph),
        depth_(depth),
        cost_(graph.size()),
        length_(graph.size(), kFar),
        parent_(graph.size(), kNone),
        reach_(graph.size(), -kFar),
        place_(graph.size(), kNone) {
    const auto half = static_cast<float>(0.5 * graph.finest()), whole = static_cast<float>(graph.finest());
    for (Index n = 0; n < graph.size(); ++n) {
      const float inner = (depth[n] - half + whole * occupancy[n]) / whole;
      cost_[n] = 1 / (inner * inner * inner * inner);
    }
  }

  /// Measures the component of a voxel from its root: the known end if there is one, else the farthest voxel.
  Index root_component(Index any, Index known, std::vector<float>& scratch) {
    const Index root = known != kNone ? known : measure_lengths(graph_, any, scratch);
    measure_lengths(graph_, root, length_);
    find_parents(root);
    return root;
  }

  const std::vector<float>& length() const { return length_; }

  void start_at(Index root) { add_voxel(root); }
  bool is_near_path(Index n) const { return reach_[n] >= 0; }
  bool has_path(Index n) const { return place_[n] != kNone; }

  /// Joins a voxel with the paths that are there.
  void add_path_from(Index n) {
    std::vector<Index> path;
    for (; n != kNone && !has_path(n); n = parent_[n]) path.push_back(n);
    if (n != kNone) path.push_back(n);
    add(path);
  }

  /// Known ends reach as far as their cross-section does, which the depth at an end does not tell.
  void mark_end(Index n, double radius) { spread({{n, reach_at(radius)}}); }

  void add_loop(const FrontGraph& fronts, const FrontGraph::Loop& loop) {
    const Index top = least_cost(fronts.voxels_of(loop.meeting)), bottom = least_cost(fronts.voxels_of(loop.parting));
    add_path_from(bottom);
    for (const std::vector<Index>& side : loop.sides) add(path_along(fronts, loop, side, top, bottom));
  }

  VesselPaths take() { return std::move(paths_); }
  Index place_of(Index n) const { return place_[n]; }
  void count_loop() { ++paths_.loops; }

  double least_loop(Index voxel) const {
    return kLoopDepths * depth_[voxel] +
           std::max(kLoopVoxels * graph_.finest(), kLoopSlices * graph_.spacing().maxCoeff());
  }

 private:
  float reach_at(double depth) const { return static_cast<float>(kNearDepths * depth); }

  void find_parents(Index root) {
    NearestFirst queue;
    if (way_.empty()) way_.assign(graph_.size(), kFar);
    queue.emplace(way_[root] = 0, root);
    while (!queue.empty()) {
      const auto [way, n] = queue.top();
      queue.pop();
      if (way > way_[n]) continue;
      graph_.visit_neighbours(n, [&, w = way, from = n](Index m, float step) {
        const float longer = w + step * (cost_[from] + cost_[m]);
        if (!(longer < way_[m])) return;
        parent_[m] = from;
        queue.emplace(way_[m] = longer, m);
      });
    }
  }

  Index least_cost(const std::vector<Index>& voxels) const {
    return *std::min_element(voxels.begin(), voxels.end(),
                             [&](Index a, Index b) { return std::pair(cost_[a], a) < std::pair(cost_[b], b); });
  }

  /// The cheapest path from `top` to `bottom` through the fronts of one side, and those a little beyond the meeting and
  /// the parting: where two vessels kiss near a branching, it is the branching that the path should take.
  std::vector<Index> path_along(const FrontGraph& fronts, const FrontGraph::Loop& loop, const std::vector<Index>& side,
                                Index top, Index bottom) {
    side_way_.resize(graph_.size(), kFar);
    side_parent_.resize(graph_.size(), kNone);
    const double more = kBeyondDepths * std::max(depth_[top], depth_[bottom]) + kBeyond * loop.persistence;
    const auto allowed = [&](Index m) {
      const Index front = fronts.front_of(m);
      const double above = fronts.level_mm(front) - fronts.level_mm(loop.meeting);
      const double below = fronts.level_mm(loop.parting) - fronts.level_mm(front);
      if (above > 0 || below > 0) return std::max(above, below) < more;
      return front == loop.parting || front == loop.meeting || std::binary_search(side.begin(), side.end(), front);
    };
    std::vector<Index> touched = {top};
    NearestFirst queue;
    queue.emplace(side_way_[top] = 0, top);
    while (!queue.empty()) {
      const auto [way, n] = queue.top();
      queue.pop();
      if (n == bottom) break;
      if (way > side_way_[n]) continue;
      graph_.visit_neighbours(n, [&, w = way, from = n](Index m, float step) {
        const float price = (cost_[from] + cost_[m]) * (has_path(from) && has_path(m) ? kOnPath : 1);
        const float longer = w + step * price;
        if (!(longer < side_way_[m]) || !allowed(m)) return;
        if (side_way_[m] == kFar) touched.push_back(m);
        side_parent_[m] = from;
        queue.emplace(side_way_[m] = longer, m);
      });
    }
    std::vector<Index> path;
    if (side_way_[bottom] < kFar)
      for (Index n = bottom; n != kNone; n = n == top ? kNone : side_parent_[n]) path.push_back(n);
    for (const Index n : touched) side_way_[n] = kFar, side_parent_[n] = kNone;
    return path;
  }

  Index add_voxel(Index n) {
    if (place_[n] == kNone) {
      place_[n] = static_cast<Index>(paths_.voxels.size());
      paths_.voxels.push_back(n);
      neighbours_.emplace_back();
    }
    return place_[n];
  }

  void add(const std::vector<Index>& path) {
    std::vector<std::pair<Index, float>> fresh;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (!has_path(path[i])) fresh.emplace_back(path[i], reach_at(depth_[path[i]]));
      const Index place = add_voxel(path[i]);
      if (i == 0) continue;
      const Index before = place_[path[i - 1]];
      std::vector<Index>& known = neighbours_[std::min(place, before)];
      if (std::find(known.begin(), known.end(), std::max(place, before)) != known.end()) continue;
      known.push_back(std::max(place, before));
      paths_.edges.push_back({before, place});
    }
    spread(fresh);
  }

  /// Marks what is near new voxels of paths: within their reach as the crow flies, by ways inside the vessels.
  void spread(const std::vector<std::pair<Index, float>>& sources) {
    struct Front {
      float left;
      Index voxel, source;
      bool operator<(const Front& other) const { return left < other.left; }
    };
    std::priority_queue<Front> queue;
    const auto total = [&](Index source) { return reach_of_source_[source]; };
    for (const auto& [n, reach] : sources) {
      reach_of_source_[n] = reach;
      const float left = reach - graph_.distance_beyond(n, n, kNearVoxels);
      if (left > reach_[n]) queue.push({reach_[n] = left, n, n});
    }
    while (!queue.empty()) {
      const Front front = queue.top();
      queue.pop();
      if (front.left < reach_[front.voxel]) continue;
      graph_.visit_neighbours(front.voxel, [&](Index m, float) {
        const float left = total(front.source) - graph_.distance_beyond(front.source, m, kNearVoxels);
        if (left < 0 || !(left > reach_[m])) return;
        queue.push({reach_[m] = left, m, front.source});
      });
    }
  }

  const VoxelGraph& graph_;
  const std::vector<float>& depth_;
  std::vector<float> cost_, length_, way_;
  std::vector<Index> parent_;
  std::vector<float> reach_;  // how much farther a path reaches beyond a voxel, mm
  std::unordered_map<Index, float> reach_of_source_;
  std::vector<Index> place_;                    // in paths_
  std::vector<std::vector<Index>> neighbours_;  // of every voxel with a path, those of higher place
  std::vector<float> side_way_;
  std::vector<Index> side_parent_;
  VesselPaths paths_;
};

/// Voxels, farthest from their root first.
std::vector<Index> farthest_first(const std::vector<float>& length) {
  std::vector<Index> order(length.size());
  for (Index n = 0; n < order.size(); ++n) order[n] = n;
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::pair(length[a], b) > std::pair(length[b], a); });
  return order;
}

}  // namespace

VesselPaths find_paths(const VoxelGraph& graph, const std::vector<float>& depth, const std::vector<float>& occupancy,
                       std::span<const KnownEnd> ends, const Progress& progress) {
  PathFinder finder(graph, depth, occupancy);
  const std::vector<Index> component = components_of(graph);
  std::vector<Index> known;  // of every component, the widest known end
  std::vector<double> width;
  for (const Index c : component)
    if (c >= known.size()) known.resize(c + 1, kNone), width.resize(c + 1, 0);
  for (const KnownEnd& end : ends)
    if (end.voxel != kNone && end.radius > width[component[end.voxel]])
      known[component[end.voxel]] = end.voxel, width[component[end.voxel]] = end.radius;
  std::vector<float> scratch(graph.size(), kFar);
  std::vector<Index> roots;
  Index seen = 0;
  for (Index n = 0; n < graph.size(); ++n) {
    if (component[n] != seen) continue;
    report_progress(progress, "skeleton", 0.5 * static_cast<double>(n) / static_cast<double>(graph.size()));
    roots.push_back(finder.root_component(n, known[seen], scratch));
    finder.start_at(roots.back());
    ++seen;
  }
  const FrontGraph fronts(graph, finder.length());
  for (const FrontGraph::Loop& loop : fronts.loops([&](Index voxel) { return finder.least_loop(voxel); })) {
    report_progress(progress, "skeleton", 0.5);
    finder.add_loop(fronts, loop);
    finder.count_loop();
  }
  for (const KnownEnd& end : ends) {
    if (end.voxel == kNone) continue;
    finder.add_path_from(end.voxel);
    finder.mark_end(end.voxel, end.radius);
  }
  std::size_t seen_voxels = 0;
  for (const Index n : farthest_first(finder.length())) {
    if (seen_voxels++ % kBetweenReports == 0)
      report_progress(progress, "skeleton",
                      0.5 + 0.5 * static_cast<double>(seen_voxels) / static_cast<double>(graph.size()));
    if (!finder.is_near_path(n) && !finder.has_path(n)) finder.add_path_from(n);
  }
  std::vector<Index> places;
  for (const KnownEnd& end : ends) places.push_back(end.voxel == kNone ? kNone : finder.place_of(end.voxel));
  VesselPaths paths = finder.take();
  paths.known_ends = std::move(places);
  paths.component = component;
  paths.roots = std::move(roots);
  return paths;
}

}  // namespace vmesh::skeleton
