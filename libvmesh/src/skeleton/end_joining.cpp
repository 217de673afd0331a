#include "end_joining.h"

#include <algorithm>
#include <cmath>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/disjoint_sets.h"

#include "cone_fit.h"

namespace vmesh::skeleton {
namespace {

constexpr double kTouching = 0.5;  // share of `join` up to which the direction does not matter
constexpr double kVoxels = 3;      // a gap that is joined however thin the vessels
constexpr double kAhead = 0.5;     // cosine between an end's direction and the way over the gap
constexpr double kAround = 2;      // radii over which an end's direction is measured

struct Candidate {
  double cost, gap;
  Index from, to;
};

/// Out of the vessel, along its last `kAround` radii.
Vec3 direction_at(const Graph& graph, const std::vector<std::vector<Index>>& edges_at, Index end) {
  const Node& tip = graph.nodes[end];
  Index n = end, before = kNone;
  while (n == end ||
         (edges_at[n].size() == 2 && (graph.nodes[n].position - tip.position).norm() < kAround * tip.radius)) {
    const Index e = edges_at[n][edges_at[n].size() == 2 && edges_at[n][0] == before ? 1 : 0];
    before = e;
    n = other_end(graph, e, n);
  }
  return (tip.position - graph.nodes[n].position).normalized();
}

std::vector<Candidate> candidates_of(const Graph& graph, DisjointSets& sets, double join, double voxel) {
  const auto edges_at = incidence(graph);
  const GraphCones cones(graph);
  const BoxTree tree = cones.tree();
  std::vector<Candidate> candidates;
  for (Index end = 0; end < graph.nodes.size(); ++end) {
    if (edges_at[end].size() > 1 || graph.nodes[end].fixed) continue;
    const Node& tip = graph.nodes[end];
    const Vec3 ahead = edges_at[end].empty() ? Vec3(Vec3::Zero()) : direction_at(graph, edges_at, end);
    const double farthest = tip.radius + std::max(join * tip.radius, kVoxels * voxel);
    tree.visit(tip.position, farthest, [&](Index c) {
      if (sets.find(cones.first_node(c)) == sets.find(end)) return;
      const RoundCone& cone = cones.cone(c);
      const auto [distance, t] = cone.distance_to(tip.position);
      const double gap = distance - tip.radius;
      const double reach = join * std::min(tip.radius, cone.radius_at(t));
      if (gap > std::max(reach, kVoxels * voxel)) return;
      const Vec3 way = cone.origin + t * cone.axis - tip.position;
      const double cosine = way.norm() > 0 ? ahead.dot(way.normalized()) : 1;
      const bool touches = gap <= std::max(kTouching * reach, kVoxels * voxel);
      if (!touches && !edges_at[end].empty() && cosine < kAhead) return;
      const Index to = t < 0.5 ? cones.first_node(c) : cones.last_node(c);
      candidates.push_back({std::max(gap, 0.0) + (1 - cosine) * tip.radius, gap, end, to});
    });
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

}  // namespace

std::vector<JoinedGap> join_ends(Graph& graph, double join, double voxel) {
  std::vector<JoinedGap> joined;
  if (!(join > 0) || graph.edges.empty()) return joined;
  DisjointSets sets(graph.nodes.size());
  for (const auto& [a, b] : graph.edges) sets.join(a, b);
  for (const Candidate& candidate : candidates_of(graph, sets, join, voxel)) {
    if (!sets.join(candidate.from, candidate.to)) continue;
    graph.edges.push_back({candidate.from, candidate.to});
    joined.push_back(
        {graph.nodes[candidate.from].position, graph.nodes[candidate.to].position, std::max(candidate.gap, 0.0)});
  }
  return joined;
}

}  // namespace vmesh::skeleton
