#include <algorithm>
#include <tuple>

#include "cleaning_steps.h"

namespace vmesh::cleaning {
namespace {

/// Numbers representatives depth first; see CleaningOptions::canonical_order.
class CanonicalOrder {
 public:
  explicit CanonicalOrder(Workspace& work)
      : work_(work), adjacency_(work.nodes.size(), work.segments), number_(work.nodes.size(), kNone) {}

  void run() {
    for (const Index root : roots()) number_from(root);
  }

  std::vector<Index> node_order;                              // representatives
  std::vector<std::pair<Index, CenterlineSegment>> segments;  // index in the workspace, ends as new numbers

 private:
  bool before(Index a, Index b) const {
    const auto key = [&](Index n) {
      const auto& [p, r] = work_.nodes[n];
      return std::tuple(-r, p.x(), p.y(), p.z(), n);
    };
    return key(a) < key(b);
  }

  /// One node per component: the best of its ends or, for a component without ends, of all.
  std::vector<Index> roots() {
    DisjointSets joined(work_.nodes.size());
    for (const auto& [a, b] : work_.segments) joined.join(a, b);
    std::vector<Index> best(work_.nodes.size(), kNone);
    for (Index n = 0; n < work_.nodes.size(); ++n) {
      if (work_.merged.find(n) != n) continue;
      Index& root = best[joined.find(n)];
      if (root == kNone) {
        root = n;
        continue;
      }
      const bool n_is_end = adjacency_.degree(n) <= 1, root_is_end = adjacency_.degree(root) <= 1;
      if (n_is_end != root_is_end ? n_is_end : before(n, root)) root = n;
    }
    std::erase(best, kNone);
    std::sort(best.begin(), best.end(), [this](Index a, Index b) { return before(a, b); });
    return best;
  }

  Index other_end(Index s, Index n) const {
    return work_.segments[s].a == n ? work_.segments[s].b : work_.segments[s].a;
  }

  void number_from(Index root) {
    std::vector<Index> stack = {root};
    while (!stack.empty()) {
      const Index n = stack.back();
      stack.pop_back();
      if (number_[n] != kNone) continue;
      number_[n] = static_cast<Index>(node_order.size());
      node_order.push_back(n);
      visit(n, stack);
    }
  }

  /// Emits the segments to nodes numbered before `n`, lowest number first, and stacks the other neighbours.
  void visit(Index n, std::vector<Index>& stack) {
    const std::size_t first_new = segments.size();
    std::vector<Index> ahead;
    for (Index i = adjacency_.offsets[n]; i < adjacency_.offsets[n + 1]; ++i) {
      const Index s = adjacency_.segments[i];
      const Index m = other_end(s, n);
      if (number_[m] == kNone) {
        ahead.push_back(m);
      } else {
        segments.push_back({s, {number_[m], number_[n]}});
      }
    }
    std::sort(segments.begin() + static_cast<std::ptrdiff_t>(first_new), segments.end(),
              [](const auto& s, const auto& t) { return s.second.a < t.second.a; });
    std::sort(ahead.begin(), ahead.end(), [this](Index a, Index b) { return before(b, a); });
    stack.insert(stack.end(), ahead.begin(), ahead.end());
  }

  Workspace& work_;
  Adjacency adjacency_;
  std::vector<Index> number_;
};

CleanedCenterline assemble(Workspace& work, const std::vector<Index>& node_order,
                           const std::vector<std::pair<Index, CenterlineSegment>>& order) {
  std::vector<CenterlineNode> nodes;
  nodes.reserve(node_order.size());
  for (const Index n : node_order) nodes.push_back(work.nodes[n]);
  std::vector<CenterlineSegment> segments;
  std::vector<Index> raw_segment;
  for (const auto& [s, segment] : order) {
    segments.push_back(segment);
    raw_segment.push_back(work.raw_segment[s]);
  }
  return {Centerline(std::move(nodes), std::move(segments)),
          std::move(work.report),
          node_order,
          std::move(raw_segment),
          {}};
}

}  // namespace

CleanedCenterline build(Workspace& work) {
  if (work.options.canonical_order) {
    CanonicalOrder order(work);
    order.run();
    return assemble(work, order.node_order, order.segments);
  }
  std::vector<Index> node_order, number(work.nodes.size(), kNone);
  for (Index n = 0; n < work.nodes.size(); ++n) {
    if (work.merged.find(n) != n) continue;
    number[n] = static_cast<Index>(node_order.size());
    node_order.push_back(n);
  }
  std::vector<std::pair<Index, CenterlineSegment>> segments;
  for (Index s = 0; s < work.segments.size(); ++s) {
    segments.push_back({s, {number[work.segments[s].a], number[work.segments[s].b]}});
  }
  return assemble(work, node_order, segments);
}

}  // namespace vmesh::cleaning
