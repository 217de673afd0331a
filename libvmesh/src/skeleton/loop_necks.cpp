#include "loop_necks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

// A stretch between two vessels that kiss is no longer than this times both their radii, and so many voxels.
constexpr double kContactRadii = 1.5, kContactVoxels = 4;

struct Stretch {
  Chain chain;
  double length = 0, least = 0;  ///< mm; least radius
  Index thinnest = kNone;        ///< node
  double width = 0;              ///< radius of the thinner vessel at its two ends
  double strength = 0;           ///< below 1 for contacts
  bool is_contact = false;
};

Stretch stretch_of(const Graph& graph, Chain chain, double widest, double voxel) {
  Stretch s;
  s.least = std::numeric_limits<double>::infinity();
  for (const Index n : chain.nodes)
    if (graph.nodes[n].radius < s.least) s.least = graph.nodes[n].radius, s.thinnest = n;
  for (const Index e : chain.edges) s.length += graph.length(e);
  const double first = graph.nodes[chain.nodes.front()].radius, last = graph.nodes[chain.nodes.back()].radius;
  s.width = std::min(first, last);
  s.is_contact = chain.nodes.front() != chain.nodes.back() &&
                 s.length <= kContactRadii * (first + last) + kContactVoxels * voxel;
  s.strength = s.is_contact ? s.least / s.width : 1 + s.least / widest;
  s.chain = std::move(chain);
  return s;
}

std::vector<Stretch> stretches_of(const Graph& graph, double voxel) {
  double widest = 0;
  for (const Node& node : graph.nodes) widest = std::max(widest, node.radius);
  std::vector<Stretch> all;
  for (Chain& chain : chains_of(graph)) all.push_back(stretch_of(graph, std::move(chain), widest, voxel));
  return all;
}

/// Stretches that close loops when the strongest are taken first: the weakest of every loop.
std::vector<std::size_t> weakest(const Graph& graph, const std::vector<Stretch>& stretches) {
  std::vector<std::size_t> order(stretches.size()), closing;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stretches[a].strength > stretches[b].strength; });
  DisjointSets sets(graph.nodes.size());
  for (const std::size_t s : order)
    if (!sets.join(stretches[s].chain.nodes.front(), stretches[s].chain.nodes.back())) closing.push_back(s);
  std::reverse(closing.begin(), closing.end());
  return closing;
}

/// Length of the way between two nodes that uses no edge of `without`.
double way_between(const Graph& graph, const std::vector<std::vector<Index>>& edges_at, Index from, Index to,
                   const std::vector<bool>& without) {
  std::vector<double> length(graph.nodes.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.emplace(length[from] = 0, from);
  while (!queue.empty()) {
    const auto [way, n] = queue.top();
    queue.pop();
    if (n == to) return way;
    if (way > length[n]) continue;
    for (const Index e : edges_at[n]) {
      if (without[e]) continue;
      const Index m = other_end(graph, e, n);
      if (const double longer = way + graph.length(e); longer < length[m]) queue.emplace(length[m] = longer, m);
    }
  }
  return 0;
}

/// Removes the stretch from its thinner end on until it has left the vessel that it branches off from.
void cut_off(const Graph& graph, const Stretch& stretch, std::vector<bool>& removed) {
  const Chain& chain = stretch.chain;
  const std::size_t count = chain.edges.size();
  const auto next_to = [&](bool backwards) { return graph.nodes[chain.nodes[backwards ? count - 1 : 1]].radius; };
  const bool backwards = next_to(true) < next_to(false);
  const Node& root = graph.nodes[backwards ? chain.nodes.back() : chain.nodes.front()];
  for (std::size_t i = 0; i + 1 < count; ++i) {
    removed[chain.edges[backwards ? count - 1 - i : i]] = true;
    const Node& end = graph.nodes[chain.nodes[backwards ? count - 1 - i : i + 1]];
    if ((end.position - root.position).norm() > root.radius) return;
  }
}

}  // namespace

std::vector<VesselLoop> find_loops(Graph& graph, double voxel, bool open) {
  const std::vector<Stretch> stretches = stretches_of(graph, voxel);
  std::vector<VesselLoop> loops;
  std::vector<bool> closing(graph.edges.size(), false), removed(graph.edges.size(), false);
  const std::vector<std::size_t> chosen = weakest(graph, stretches);
  if (chosen.empty()) return loops;
  for (const std::size_t s : chosen)
    for (const Index e : stretches[s].chain.edges) closing[e] = true;
  const auto edges_at = incidence(graph);
  for (const std::size_t s : chosen) {
    const Stretch& stretch = stretches[s];
    const double around =
        way_between(graph, edges_at, stretch.chain.nodes.front(), stretch.chain.nodes.back(), closing);
    loops.push_back({graph.nodes[stretch.thinnest].position, stretch.least, stretch.width, stretch.length + around, open});
    if (!open) continue;
    if (stretch.is_contact) {
      for (const Index e : stretch.chain.edges) removed[e] = true;
    } else {
      cut_off(graph, stretch, removed);
    }
  }
  remove_edges(graph, removed);
  return loops;
}

}  // namespace vmesh::skeleton
