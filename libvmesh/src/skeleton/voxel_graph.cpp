#include "voxel_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

constexpr int kGap = 2;                // voxels from centre to centre across a gap of one voxel
constexpr int kFragmentSide = 8;       // a fragment fits into a box of this side, voxels
constexpr std::size_t kFragment = 64;  // and has at most this many

struct Extent {
  Voxel low, high;
  std::size_t count = 0;

  bool is_fragment() const {
    if (count > kFragment) return false;
    for (int a = 0; a < 3; ++a)
      if (high[a] - low[a] >= kFragmentSide) return false;
    return true;
  }
};

std::vector<Extent> extents_of(const VoxelGraph& graph, const std::vector<Index>& component) {
  std::vector<Extent> extents;
  for (Index n = 0; n < graph.size(); ++n) {
    const Voxel& v = graph.voxel(n);
    if (component[n] >= extents.size()) extents.resize(component[n] + 1, {v, v, 0});
    Extent& extent = extents[component[n]];
    for (int a = 0; a < 3; ++a) {
      extent.low[a] = std::min(extent.low[a], v[a]);
      extent.high[a] = std::max(extent.high[a], v[a]);
    }
    ++extent.count;
  }
  return extents;
}

}  // namespace

VoxelGraph::VoxelGraph(const VoxelSet& voxels, const Vec3& spacing)
    : set_(&voxels), spacing_(spacing), voxel_(voxels.voxels()) {
  std::size_t at = 0;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) lengths_[at++] = static_cast<float>(Vec3(i, j, k).cwiseProduct(spacing).norm());
}

void VoxelGraph::add_bridges(std::span<const Bridge> bridges) {
  has_bridge_.resize(size(), 0);
  for (const Bridge& bridge : bridges) {
    bridges_.push_back(bridge);
    has_bridge_[bridge.a] = has_bridge_[bridge.b] = 1;
  }
}

float VoxelGraph::distance(Index a, Index b) const {
  const Voxel &v = voxel_[a], &w = voxel_[b];
  return static_cast<float>(Vec3(w[0] - v[0], w[1] - v[1], w[2] - v[2]).cwiseProduct(spacing_).norm());
}

float VoxelGraph::distance_beyond(Index a, Index b, double voxels) const {
  const Voxel &v = voxel_[a], &w = voxel_[b];
  const Vec3 steps(w[0] - v[0], w[1] - v[1], w[2] - v[2]);
  const double count = steps.norm();
  if (count == 0) return static_cast<float>(-voxels * finest());
  return static_cast<float>(steps.cwiseProduct(spacing_).norm() * (1 - voxels / count));
}

std::vector<Index> components_of(const VoxelGraph& graph) {
  std::vector<Index> component(graph.size(), kNone);
  std::vector<Index> stack;
  Index count = 0;
  for (Index first = 0; first < graph.size(); ++first) {
    if (component[first] != kNone) continue;
    component[first] = count;
    stack.push_back(first);
    while (!stack.empty()) {
      const Index n = stack.back();
      stack.pop_back();
      graph.visit_neighbours(n, [&](Index m, float) {
        if (component[m] != kNone) return;
        component[m] = count;
        stack.push_back(m);
      });
    }
    ++count;
  }
  return component;
}

std::vector<VoxelGraph::Bridge> bridges_to_fragments(const VoxelGraph& graph, const std::vector<Index>& component) {
  const std::vector<Extent> extents = extents_of(graph, component);
  if (extents.size() < 2) return {};
  std::map<std::pair<Index, Index>, VoxelGraph::Bridge> shortest;
  for (Index n = 0; n < graph.size(); ++n) {
    const Index from = component[n];
    if (!extents[from].is_fragment()) continue;
    const Voxel& v = graph.voxel(n);
    for (int k = -kGap; k <= kGap; ++k)
      for (int j = -kGap; j <= kGap; ++j)
        for (int i = -kGap; i <= kGap; ++i) {
          const Index m = graph.set().number({v[0] + i, v[1] + j, v[2] + k});
          if (m == kNone || component[m] == from) continue;
          const VoxelGraph::Bridge bridge{n, m, graph.distance(n, m)};
          const auto [at, fresh] = shortest.try_emplace(std::minmax(from, component[m]), bridge);
          if (!fresh && bridge.length < at->second.length) at->second = bridge;
        }
  }
  std::vector<VoxelGraph::Bridge> candidates, chosen;
  for (const auto& [pair, bridge] : shortest) candidates.push_back(bridge);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.length < b.length; });
  DisjointSets joined(extents.size());
  for (const VoxelGraph::Bridge& bridge : candidates)
    if (joined.join(component[bridge.a], component[bridge.b])) chosen.push_back(bridge);
  return chosen;
}

Index measure_lengths(const VoxelGraph& graph, Index source, std::vector<float>& length) {
  // No step is shorter than a bucket, so the voxels of one bucket are final when it is their turn (Dial 1969).
  const auto width = static_cast<float>(graph.finest());
  std::vector<std::vector<Index>> buckets(static_cast<std::size_t>(kGap * graph.longest_step() / width) + 4);
  length[source] = 0;
  buckets[0].push_back(source);
  Index farthest = source;
  std::size_t waiting = 1;
  for (std::size_t turn = 0; waiting > 0; ++turn) {
    std::vector<Index> now = std::move(buckets[turn % buckets.size()]);
    buckets[turn % buckets.size()].clear();
    waiting -= now.size();
    for (const Index n : now) {
      if (static_cast<std::size_t>(length[n] / width) != turn) continue;  // reached again on a shorter way
      if (length[n] > length[farthest]) farthest = n;
      graph.visit_neighbours(n, [&](Index m, float step) {
        const float way = length[n] + step;
        if (!(way < length[m])) return;
        length[m] = way;
        buckets[static_cast<std::size_t>(way / width) % buckets.size()].push_back(m);
        ++waiting;
      });
    }
  }
  return farthest;
}

}  // namespace vmesh::skeleton
