#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "vmesh/core/box_tree.h"

namespace vmesh {

/// A tree of axis-aligned boxes that change, and to which others are added. What it answers depends on the boxes only;
/// how fast it does, on how far they have moved since the tree was made.
class ChangingBoxTree {
 public:
  using Box = BoxTree::Box;
  struct Item {
    Index number;
    Box box;
  };

  ChangingBoxTree() = default;
  /// Numbers differ. O(n log n).
  explicit ChangingBoxTree(const std::vector<Item>& items);

  /// The number of items.
  std::size_t size() const { return size_; }
  bool has(Index item) const { return item < leaf_of_.size() && leaf_of_[item] != kNone; }
  /// The box of an item that it has.
  const Box& box(Index item) const { return boxes_[item]; }
  /// Changes the item's box, or adds the item. O(depth).
  void set(Index item, const Box& box);

  /// Whether test(item, box) holds for an item whose box overlaps the box [low, high]; calls it until it does. Adds to
  /// `visited` how many boxes it looked at.
  template <class Test>
  bool any_overlapping(const Vec3& low, const Vec3& high, std::size_t& visited, Test&& test) const {
    if (size_ == 0) return false;
    const Box sought{low, high};
    return any_within(0, sought, Bounds(sought), visited, test);
  }

  /// Calls visit(item, box) for every item.
  template <class Visit>
  void visit(Visit&& visit_item) const {
    for (const Siblings& siblings : nodes_) {
      for (const Node& node : siblings) {
        if (node.item != kNone) visit_item(node.item, boxes_[node.item]);
      }
    }
  }

 private:
  // A box that holds another, in half the memory.
  struct Bounds {
    Bounds() = default;
    explicit Bounds(const Box& box) {
      for (int i = 0; i < 3; ++i) {
        low[static_cast<std::size_t>(i)] = nearest(box.low[i]) - room(box.low[i]);
        high[static_cast<std::size_t>(i)] = nearest(box.high[i]) + room(box.high[i]);
      }
    }

    static float nearest(double x) {
      constexpr double kLargest = std::numeric_limits<float>::max();
      return static_cast<float>(std::clamp(x, -kLargest, kLargest));
    }
    // Twice what rounding to a float may move a coordinate by, or more.
    static float room(double x) {
      return std::abs(nearest(x)) * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min();
    }

    bool overlaps(const Bounds& other) const {
      bool apart = false;
      for (std::size_t i = 0; i < 3; ++i) {
        apart |= low[i] > other.high[i];
        apart |= other.low[i] > high[i];
      }
      return !apart;
    }
    Bounds joined(const Bounds& other) const {
      Bounds both;
      for (std::size_t i = 0; i < 3; ++i) {
        both.low[i] = std::min(low[i], other.low[i]);
        both.high[i] = std::max(high[i], other.high[i]);
      }
      return both;
    }
    bool operator==(const Bounds&) const = default;

    std::array<float, 3> low{}, high{};
  };
  struct Node : Bounds {
    Index first = kNone;  // inner: the first of its two children
    Index item = kNone;   // of a leaf
  };
  // Both children of a node, in one line of the cache: searches look at both. The root, number 0, has a sibling that is
  // not used.
  struct alignas(2 * sizeof(Node)) Siblings : std::array<Node, 2> {};

  Node& node(Index n) { return nodes_[n / 2][n % 2]; }
  const Node& node(Index n) const { return nodes_[n / 2][n % 2]; }
  Index& parent(Index n) { return parents_[n / 2]; }
  // Gives a node two children; returns the first.
  Index add_children(Index n);
  void make_root();

  struct Center;
  void divide(Index n, const std::vector<Item>& items, std::vector<Center>& centers, std::size_t begin,
              std::size_t end);
  void make_leaf(Index n, Index item);
  Bounds around_children(Index n) const { return node(node(n).first).joined(node(node(n).first + 1)); }
  void add(Index item);

  template <class Test>
  bool any_within(Index n, const Box& sought, const Bounds& bounds, std::size_t& visited, Test&& test) const {
    const Node& here = node(n);
    ++visited;
    if (!here.overlaps(bounds)) return false;
    if (here.first != kNone) {
      return any_within(here.first, sought, bounds, visited, test) ||
             any_within(here.first + 1, sought, bounds, visited, test);
    }
    const Box& box = boxes_[here.item];
    return box.overlaps(sought.low, sought.high) && test(here.item, box);
  }

  std::vector<Siblings> nodes_;
  std::vector<Index> parents_;  // of siblings
  std::vector<Index> leaf_of_;  // of every item
  std::vector<Box> boxes_;      // of every item
  std::size_t size_ = 0;
};

}  // namespace vmesh
