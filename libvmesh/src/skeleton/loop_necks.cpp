#include "loop_necks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh::skeleton {
namespace {

// Where two vessels kiss, the way from one to the other is thinner than this share of the thinner of them ...
constexpr double kNeck = 0.75;
// ... and that over at most this times both their radii, and this number of voxels.
constexpr double kContactRadii = 1, kContactVoxels = 4;
// In vessels thinner than this number of voxels the width changes too much from voxel to voxel to tell.
constexpr double kSeenNeck = 1.2;
// Up to this number, a short way between vessels is opened rather than a neck.
constexpr double kTrustedNeck = 2.4;
// What is left of a stretch beside a contact goes with it if it is within the vessel that it leads to: at most
// these numbers of radii and voxels.
constexpr double kRestRadii = 1.5, kRestVoxels = 3;

constexpr double kDirectionRadii = 4, kAsideRadii = 0.4, kSplitVoxels = 0.2;
constexpr int kMostPasses = 4;

/// A stretch between branchings, and its thinnest place.
struct Stretch {
  Chain chain;
  double length = 0;                ///< mm
  double width = 0;                 ///< largest bore on the thinner side of the thinnest place, mm
  std::size_t thinnest = 0;         ///< in the chain's nodes
  std::size_t first = 0, last = 0;  ///< the nodes around it that are thinner than both sides
  double strength = 0;              ///< below a half for short ways between thin vessels, below 1 for other contacts
  bool is_contact = false;
  bool may_be_crossing = false;  ///< a contact, short as a whole, where no neck is to be seen
};

double bore_of(const Graph& graph, const Chain& chain, std::size_t i) { return graph.nodes[chain.nodes[i]].bore; }

double length_between(const Graph& graph, const Chain& chain, std::size_t first, std::size_t last) {
  double length = 0;
  for (std::size_t i = first; i < last; ++i) length += graph.length(chain.edges[i]);
  return length;
}

Stretch stretch_of(const Graph& graph, Chain chain, double widest, double voxel) {
  Stretch s;
  const std::size_t count = chain.nodes.size();
  std::vector<double> before(count), after(count);  // largest bore up to a node, and from it on
  for (std::size_t i = 0; i < count; ++i) before[i] = std::max(bore_of(graph, chain, i), i > 0 ? before[i - 1] : 0.0);
  for (std::size_t i = count; i-- > 0;)
    after[i] = std::max(bore_of(graph, chain, i), i + 1 < count ? after[i + 1] : 0.0);
  const auto share = [&](std::size_t i) { return bore_of(graph, chain, i) / std::min(before[i], after[i]); };
  for (std::size_t i = 0; i < count; ++i)
    if (share(i) < share(s.thinnest)) s.thinnest = i;
  s.width = std::min(before[s.thinnest], after[s.thinnest]);
  s.first = s.last = s.thinnest;
  while (s.first > 0 && bore_of(graph, chain, s.first - 1) < kNeck * s.width) --s.first;
  while (s.last + 1 < count && bore_of(graph, chain, s.last + 1) < kNeck * s.width) ++s.last;
  s.length = length_between(graph, chain, 0, count - 1);
  const double thin = length_between(graph, chain, s.first, s.last);
  const double short_way = kContactRadii * (before[s.thinnest] + after[s.thinnest]) + kContactVoxels * voxel;
  // Between thin vessels there is no neck to see, but the way from one to the other is short.
  const bool is_bridge = chain.nodes.front() != chain.nodes.back() && s.length <= short_way;
  const bool is_neck = !is_bridge && share(s.thinnest) < kNeck && thin <= short_way && s.width > kSeenNeck * voxel;
  if (is_bridge) s.first = 0, s.last = count - 1;
  if (s.first == s.last) (s.last + 1 < count ? s.last : s.first) += s.last + 1 < count ? 1 : -1;
  s.is_contact = is_neck || is_bridge;
  s.may_be_crossing = is_bridge && (share(s.thinnest) >= kNeck || s.width <= kSeenNeck * voxel);
  const bool first_choice = is_bridge && s.width <= kTrustedNeck * voxel;
  s.strength = first_choice   ? 0.5 * share(s.thinnest)
               : s.is_contact ? 0.5 + 0.5 * share(s.thinnest)
                              : 1 + bore_of(graph, chain, s.thinnest) / widest;
  s.chain = std::move(chain);
  return s;
}

std::vector<Stretch> stretches_of(const Graph& graph, double voxel) {
  double widest = 0;
  for (const Node& node : graph.nodes) widest = std::max(widest, node.bore);
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

/// The direction in which a stretch leaves a branching, over a few of its radii.
Vec3 direction_from(const Graph& graph, const std::vector<std::vector<Index>>& edges_at, Index node, Index edge) {
  const Node& from = graph.nodes[node];
  Index n = other_end(graph, edge, node), e = edge;
  while (edges_at[n].size() == 2 && (graph.nodes[n].position - from.position).norm() < kDirectionRadii * from.radius) {
    e = edges_at[n][edges_at[n][0] == e ? 1 : 0];
    n = other_end(graph, e, n);
  }
  return (graph.nodes[n].position - from.position).normalized();
}

/// How two vessels that share a stretch go on: the edges at its last node that continue those at its first.
struct Uncrossing {
  std::array<Index, 2> before{}, after{};  // edges: before[i] and after[i] belong to one vessel
  Vec3 aside = Vec3::Zero();               // from the second vessel to the first
};

/// Whether two vessels cross in the stretch rather than lie on either side of it: what goes on straight tells.
std::optional<Uncrossing> uncrossing_at(const Graph& graph, const std::vector<std::vector<Index>>& edges_at,
                                        const Stretch& stretch) {
  const Index first = stretch.chain.nodes.front(), last = stretch.chain.nodes.back();
  std::vector<Index> before, after;
  for (const Index e : edges_at[first])
    if (e != stretch.chain.edges.front()) before.push_back(e);
  for (const Index e : edges_at[last])
    if (e != stretch.chain.edges.back()) after.push_back(e);
  if (before.size() != 2 || after.size() != 2) return std::nullopt;
  std::array<Vec3, 2> from, to;
  for (std::size_t i = 0; i < 2; ++i) {
    from[i] = direction_from(graph, edges_at, first, before[i]);
    to[i] = direction_from(graph, edges_at, last, after[i]);
  }
  const double beside = from[0].dot(from[1]) + to[0].dot(to[1]);  // -2: each vessel stays on its side
  const double straight = from[0].dot(to[0]) + from[1].dot(to[1]), across = from[0].dot(to[1]) + from[1].dot(to[0]);
  if (beside <= std::min(straight, across)) return std::nullopt;
  if (across < straight) std::swap(after[0], after[1]), std::swap(to[0], to[1]);
  return Uncrossing{{before[0], before[1]}, {after[0], after[1]}, (from[0] + to[0] - from[1] - to[1]).normalized()};
}

std::size_t component_count(const Graph& graph, const std::vector<bool>& without) {
  DisjointSets sets(graph.nodes.size());
  std::size_t count = graph.nodes.size();
  for (Index e = 0; e < graph.edges.size(); ++e)
    if ((e >= without.size() || !without[e]) && sets.join(graph.edges[e][0], graph.edges[e][1])) --count;
  return count;
}

/// Gives the second vessel a stretch of its own, unless it would then be apart.
bool uncross(Graph& graph, const Stretch& stretch, const Uncrossing& vessels, const std::vector<bool>& without) {
  const Chain& chain = stretch.chain;
  const Graph before = graph;
  std::vector<Index> copies;
  for (const Index n : chain.nodes) {
    copies.push_back(static_cast<Index>(graph.nodes.size()));
    Node copy = graph.nodes[n];
    const Vec3 aside = kAsideRadii * copy.radius * vessels.aside;
    copy.position -= aside;
    graph.nodes[n].position += aside;
    graph.nodes.push_back(copy);
  }
  for (std::size_t i = 0; i + 1 < copies.size(); ++i) graph.edges.push_back({copies[i], copies[i + 1]});
  for (Index& n : graph.edges[vessels.before[1]])
    if (n == chain.nodes.front()) n = copies.front();
  for (Index& n : graph.edges[vessels.after[1]])
    if (n == chain.nodes.back()) n = copies.back();
  if (component_count(graph, without) == component_count(before, without)) return true;
  graph = before;
  return false;
}

/// Four stretches that meet at one node cross in a stretch of no length: makes two nodes of it, close to each other.
void split_crossings(Graph& graph, double voxel) {
  const Graph given = graph;  // what the incidence is of
  const auto edges_at = incidence(given);
  for (Index n = 0; n < given.nodes.size(); ++n) {
    if (edges_at[n].size() != 4) continue;
    std::array<Vec3, 4> away;
    for (std::size_t i = 0; i < 4; ++i) away[i] = direction_from(given, edges_at, n, edges_at[n][i]);
    std::size_t straight = 1;  // goes on from the first
    for (std::size_t i = 2; i < 4; ++i)
      if (away[0].dot(away[i]) < away[0].dot(away[straight])) straight = i;
    const std::size_t other = straight == 1 ? 2 : 1;
    const auto fresh = static_cast<Index>(graph.nodes.size());
    Node copy = graph.nodes[n];
    copy.position += kSplitVoxels * voxel * (away[straight] + away[6 - straight - other - 0]).normalized();
    graph.nodes.push_back(copy);
    for (const std::size_t i : {straight, 6 - straight - other})
      for (Index& end : graph.edges[edges_at[n][i]])
        if (end == n) end = fresh;
    graph.edges.push_back({n, fresh});
  }
}

/// Removes a contact, and what is left beside it if that is within the vessels that touch.
void remove_contact(const Graph& graph, const Stretch& stretch, double voxel, std::vector<bool>& removed) {
  const Chain& chain = stretch.chain;
  const std::size_t end = chain.nodes.size() - 1;
  const auto is_within = [&](std::size_t from, std::size_t to, std::size_t vessel) {
    return length_between(graph, chain, from, to) <= kRestRadii * bore_of(graph, chain, vessel) + kRestVoxels * voxel;
  };
  std::size_t first = stretch.first, last = stretch.last;
  if (is_within(0, first, 0)) first = 0;
  if (is_within(last, end, end)) last = end;
  for (std::size_t i = first; i < last; ++i) removed[chain.edges[i]] = true;
}

/// Removes the stretch from its thinner end on until it has left the vessel that it branches off from.
void cut_off(const Graph& graph, const Stretch& stretch, std::vector<bool>& removed) {
  const Chain& chain = stretch.chain;
  const std::size_t count = chain.edges.size();
  const auto next_to = [&](bool backwards) { return graph.nodes[chain.nodes[backwards ? count - 1 : 1]].bore; };
  const bool backwards = next_to(true) < next_to(false);
  const Node& root = graph.nodes[backwards ? chain.nodes.back() : chain.nodes.front()];
  for (std::size_t i = 0; i + 1 < count; ++i) {
    removed[chain.edges[backwards ? count - 1 - i : i]] = true;
    const Node& end = graph.nodes[chain.nodes[backwards ? count - 1 - i : i + 1]];
    if ((end.position - root.position).norm() > root.radius) return;
  }
}

/// The loops, and with `open` one pass of opening them.
std::vector<VesselLoop> pass(Graph& graph, double voxel, bool open) {
  const std::vector<Stretch> stretches = stretches_of(graph, voxel);
  std::vector<VesselLoop> loops;
  std::vector<bool> closing(graph.edges.size(), false), removed(graph.edges.size(), false);
  const std::vector<std::size_t> chosen = weakest(graph, stretches);
  for (const std::size_t s : chosen)
    for (const Index e : stretches[s].chain.edges) closing[e] = true;
  const auto edges_at = incidence(graph);
  std::vector<bool> touched(graph.nodes.size(), false);  // by an uncrossing
  for (const std::size_t s : chosen) {
    const Stretch& stretch = stretches[s];
    const Chain& chain = stretch.chain;
    const double around = way_between(graph, edges_at, chain.nodes.front(), chain.nodes.back(), closing);
    const Node& neck = graph.nodes[chain.nodes[stretch.thinnest]];
    loops.push_back({neck.position, neck.radius, stretch.width, stretch.length + around, open});
  }
  if (!open) return loops;
  const Graph given = graph;  // what the incidence is of
  for (const std::size_t s : chosen) {
    const Stretch& stretch = stretches[s];
    const Chain& chain = stretch.chain;
    const bool is_free = !touched[chain.nodes.front()] && !touched[chain.nodes.back()];
    const auto crossing = stretch.may_be_crossing && is_free ? uncrossing_at(given, edges_at, stretch) : std::nullopt;
    if (crossing && uncross(graph, stretch, *crossing, removed)) {
      touched[chain.nodes.front()] = touched[chain.nodes.back()] = true;
    } else if (stretch.is_contact) {
      if (is_free) remove_contact(graph, stretch, voxel, removed);
    } else {
      cut_off(graph, stretch, removed);
    }
  }
  removed.resize(graph.edges.size(), false);
  remove_with_nodes(graph, removed);
  return loops;
}

}  // namespace

std::vector<VesselLoop> find_loops(Graph& graph, double voxel, bool open) {
  if (!open) return pass(graph, voxel, false);
  if (weakest(graph, stretches_of(graph, voxel)).empty()) return {};
  split_crossings(graph, voxel);
  std::vector<VesselLoop> loops = pass(graph, voxel, true);
  // What a pass had to leave, as another crossing had changed it, comes with the next; these loops are listed already.
  for (int i = 1; i < kMostPasses && !pass(graph, voxel, true).empty(); ++i) {
  }
  break_loops(graph, 0);
  return loops;
}

}  // namespace vmesh::skeleton
