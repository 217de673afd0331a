#include "skeleton_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

/// Edges in the order of their lengths.
std::vector<Index> by_length(const Graph& graph) {
  std::vector<Index> order(graph.edges.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return graph.length(a) < graph.length(b); });
  return order;
}

/// Length of the shortest path from `from` to `to` that avoids edge `avoided`.
double way_around(const Graph& graph, const std::vector<std::vector<Index>>& edges_at, Index avoided) {
  const auto [from, to] = graph.edges[avoided];
  std::vector<double> distance(graph.nodes.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({distance[from] = 0, from});
  while (!queue.empty()) {
    const auto [d, n] = queue.top();
    queue.pop();
    if (n == to) return d;
    if (d > distance[n]) continue;
    for (const Index e : edges_at[n]) {
      if (e == avoided) continue;
      const Index m = other_end(graph, e, n);
      if (const double way = d + graph.length(e); way < distance[m]) queue.push({distance[m] = way, m});
    }
  }
  return std::numeric_limits<double>::infinity();
}

/// Edges that are not in the spanning forest of the shortest ones.
std::vector<Index> closing_edges(const Graph& graph) {
  DisjointSets parts(graph.nodes.size());
  std::vector<Index> closing;
  for (const Index e : by_length(graph)) {
    if (!parts.join(graph.edges[e][0], graph.edges[e][1])) closing.push_back(e);
  }
  return closing;
}

double length_of(const Graph& graph, const Chain& chain) {
  double length = 0;
  for (const Index e : chain.edges) length += graph.length(e);
  return length;
}

}  // namespace

void remove_edges(Graph& graph, const std::vector<bool>& removed) {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < graph.edges.size(); ++e)
    if (!removed[e]) graph.edges[kept++] = graph.edges[e];
  graph.edges.resize(kept);
}

void remove_with_nodes(Graph& graph, const std::vector<bool>& removed) {
  std::vector<char> had(graph.nodes.size(), 0), has(graph.nodes.size(), 0);
  for (Index e = 0; e < graph.edges.size(); ++e)
    for (const Index n : graph.edges[e]) (removed[e] ? had : has)[n] = 1;
  remove_edges(graph, removed);
  std::vector<Index> number(graph.nodes.size(), kNone);
  std::size_t kept = 0;
  for (Index n = 0; n < graph.nodes.size(); ++n) {
    if (had[n] && !has[n]) continue;
    number[n] = static_cast<Index>(kept);
    graph.nodes[kept++] = graph.nodes[n];
  }
  graph.nodes.resize(kept);
  for (auto& edge : graph.edges)
    for (Index& n : edge) n = number[n];
}

std::vector<std::vector<Index>> incidence(const Graph& graph) {
  std::vector<std::vector<Index>> edges_at(graph.nodes.size());
  for (Index e = 0; e < graph.edges.size(); ++e)
    for (const Index n : graph.edges[e]) edges_at[n].push_back(e);
  return edges_at;
}

std::vector<Chain> chains_of(const Graph& graph) {
  const auto edges_at = incidence(graph);
  std::vector<bool> used(graph.edges.size(), false);
  std::vector<Chain> chains;
  const auto follow = [&](Index n, Index e) {
    Chain chain{{n}, {}};
    while (!used[e]) {
      used[e] = true;
      n = other_end(graph, e, n);
      chain.nodes.push_back(n);
      chain.edges.push_back(e);
      if (edges_at[n].size() != 2) break;
      e = edges_at[n][edges_at[n][0] == e ? 1 : 0];
    }
    chains.push_back(std::move(chain));
  };
  for (const bool loops : {false, true})
    for (Index n = 0; n < graph.nodes.size(); ++n)
      if (loops || edges_at[n].size() != 2)
        for (const Index e : edges_at[n])
          if (!used[e]) follow(n, e);
  return chains;
}

std::size_t break_loops(Graph& graph, std::size_t loops) {
  std::vector<Index> closing = closing_edges(graph);
  if (closing.size() <= loops) return 0;
  const auto edges_at = incidence(graph);
  std::vector<std::pair<double, Index>> order;
  for (const Index e : closing) order.emplace_back(graph.length(e) + way_around(graph, edges_at, e), e);
  std::sort(order.begin(), order.end());
  std::vector<bool> removed(graph.edges.size(), false);
  const std::size_t count = closing.size() - loops;
  for (std::size_t i = 0; i < count; ++i) removed[order[i].second] = true;
  remove_edges(graph, removed);
  return count;
}

std::size_t prune_spurs(Graph& graph) {
  struct Spur {
    double relative = 1;  // length in radii
    std::size_t chain = 0;
  };
  for (std::size_t count = 0;;) {
    const auto edges_at = incidence(graph);
    const std::vector<Chain> chains = chains_of(graph);
    std::map<Index, Spur> shortest;  // at every node where one branches off
    for (std::size_t c = 0; c < chains.size(); ++c) {
      const Chain& chain = chains[c];
      const std::size_t first = edges_at[chain.nodes.front()].size(), last = edges_at[chain.nodes.back()].size();
      if ((first == 1) == (last == 1)) continue;  // no free end, or two
      if (graph.nodes[first == 1 ? chain.nodes.front() : chain.nodes.back()].fixed) continue;
      const Index root = first == 1 ? chain.nodes.back() : chain.nodes.front();
      const double relative = length_of(graph, chain) / graph.nodes[root].radius;
      if (Spur& spur = shortest[root]; relative < spur.relative) spur = {relative, c};
    }
    std::vector<bool> removed(graph.edges.size(), false);
    std::size_t round = 0;
    for (const auto& [root, spur] : shortest) {
      if (!(spur.relative < 1)) continue;
      for (const Index e : chains[spur.chain].edges) removed[e] = true;
      ++round;
    }
    if (round == 0) return count;
    count += round;
    remove_with_nodes(graph, removed);
  }
}

}  // namespace vmesh::skeleton
