#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// A balanced tree of axis-aligned boxes over items with a bounding box each.
class BoxTree {
 public:
  static constexpr Index kLeafSize = 4;  // items, at most

  BoxTree() = default;
  /// `low`, `high`: the items' boxes (mm). O(n log n), deterministic.
  BoxTree(const std::vector<Vec3>& low, const std::vector<Vec3>& high);

  struct Box {
    Vec3 low, high;

    bool overlaps(const Vec3& other_low, const Vec3& other_high) const {
      return (low.array() <= other_high.array()).all() && (other_low.array() <= high.array()).all();
    }
  };
  /// The same for items 0 to `count` - 1 whose boxes are computed when they are needed, twice each: takes less memory,
  /// even less with more items to a leaf.
  BoxTree(Index count, const std::function<Box(Index)>& box_of, Index leaf_size = kLeafSize);

  /// Calls visit(item) for every item whose signed distance at `p` may be at most `limit`, near boxes first. The
  /// visitor may lower `limit` as it goes, which finds a minimum.
  template <class Visit>
  void visit(const Vec3& p, const double& limit, Visit&& visit_item) const {
    if (!nodes_.empty()) visit_node(0, p, limit, visit_item);
  }

  /// Calls visit(item) for every item whose box overlaps the box [low, high].
  template <class Visit>
  void visit_overlapping(const Vec3& low, const Vec3& high, Visit&& visit_item) const {
    if (!nodes_.empty()) visit_overlapping_node(0, low, high, visit_item);
  }

  /// Whether test(item) holds for an item whose box overlaps the box [low, high], or for one in a leaf with it; calls
  /// it until it does.
  template <class Test>
  bool any_overlapping(const Vec3& low, const Vec3& high, Test&& test) const {
    return !nodes_.empty() && any_overlapping_within(0, low, high, test);
  }

  /// Calls visit(item, item) once for every two items whose boxes overlap, and for a few whose boxes do not.
  template <class Visit>
  void visit_pairs(Visit&& visit_pair) const {
    if (!nodes_.empty()) visit_pairs_within(0, visit_pair);
  }

 private:
  struct Node : Box {
    Index first = 0;  // leaf: first of its items in order_; inner: first of its two children
    Index count = 0;  // items of a leaf; 0 for an inner node

    // Signed distance to the box: a lower bound of the signed distance to whatever lies in it.
    double bound(const Vec3& p) const {
      const Vec3 outside = (low - p).cwiseMax(p - high);
      const double deepest = outside.maxCoeff();
      return deepest <= 0 ? deepest : outside.cwiseMax(0).norm();
    }
  };

  struct Item;
  void divide(Index node, std::vector<Item>& items, Index first, Index count, Index leaf_size);
  void enclose(Node& node, const std::function<Box(Index)>& box_of) const;

  template <class Visit>
  void visit_node(Index n, const Vec3& p, const double& limit, Visit&& visit_item) const {
    const Node& node = nodes_[n];
    if (node.count > 0) {
      for (Index i = 0; i < node.count; ++i) visit_item(order_[node.first + i]);
      return;
    }
    double bounds[2] = {nodes_[node.first].bound(p), nodes_[node.first + 1].bound(p)};
    const int near = bounds[1] < bounds[0] ? 1 : 0;
    for (const int child : {near, 1 - near}) {
      if (bounds[child] <= limit) visit_node(node.first + child, p, limit, visit_item);
    }
  }

  template <class Visit>
  void visit_overlapping_node(Index n, const Vec3& low, const Vec3& high, Visit&& visit_item) const {
    const Node& node = nodes_[n];
    if (!node.overlaps(low, high)) return;
    if (node.count > 0) {
      for (Index i = 0; i < node.count; ++i) visit_item(order_[node.first + i]);
      return;
    }
    visit_overlapping_node(node.first, low, high, visit_item);
    visit_overlapping_node(node.first + 1, low, high, visit_item);
  }

  template <class Test>
  bool any_overlapping_within(Index n, const Vec3& low, const Vec3& high, Test&& test) const {
    const Node& node = nodes_[n];
    if (!node.overlaps(low, high)) return false;
    if (node.count == 0) {
      return any_overlapping_within(node.first, low, high, test) ||
             any_overlapping_within(node.first + 1, low, high, test);
    }
    for (Index i = 0; i < node.count; ++i) {
      if (test(order_[node.first + i])) return true;
    }
    return false;
  }

  template <class Visit>
  void visit_pairs_within(Index n, Visit&& visit_pair) const {
    const Node& node = nodes_[n];
    if (node.count == 0) {
      visit_pairs_within(node.first, visit_pair);
      visit_pairs_within(node.first + 1, visit_pair);
      visit_pairs_between(node.first, node.first + 1, visit_pair);
      return;
    }
    for (Index i = 0; i < node.count; ++i) {
      for (Index j = 0; j < i; ++j) visit_pair(order_[node.first + i], order_[node.first + j]);
    }
  }

  template <class Visit>
  void visit_pairs_between(Index m, Index n, Visit&& visit_pair) const {
    const Node &a = nodes_[m], &b = nodes_[n];
    if (!a.overlaps(b.low, b.high)) return;
    if (a.count > 0 && b.count > 0) {
      for (Index i = 0; i < a.count; ++i) {
        for (Index j = 0; j < b.count; ++j) visit_pair(order_[a.first + i], order_[b.first + j]);
      }
    } else if (b.count > 0 || (a.count == 0 && (a.high - a.low).sum() >= (b.high - b.low).sum())) {
      visit_pairs_between(a.first, n, visit_pair);
      visit_pairs_between(a.first + 1, n, visit_pair);
    } else {
      visit_pairs_between(m, b.first, visit_pair);
      visit_pairs_between(m, b.first + 1, visit_pair);
    }
  }

  std::vector<Node> nodes_;
  std::vector<Index> order_;
};

}  // namespace vmesh
