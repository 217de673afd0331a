#pragma once

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
  const Box& box(Index item) const { return nodes_[leaf_of_[item]]; }
  /// Changes the item's box, or adds the item. O(depth).
  void set(Index item, const Box& box);

  /// Whether test(item, box) holds for an item whose box overlaps the box [low, high]; calls it until it does. Adds to
  /// `visited` how many boxes it looked at.
  template <class Test>
  bool any_overlapping(const Vec3& low, const Vec3& high, std::size_t& visited, Test&& test) const {
    return !nodes_.empty() && any_within(0, low, high, visited, test);
  }

  /// Calls visit(item, box) for every item.
  template <class Visit>
  void visit(Visit&& visit_item) const {
    for (const Node& node : nodes_) {
      if (node.first == kNone) visit_item(node.item, static_cast<const Box&>(node));
    }
  }

 private:
  struct Node : Box {
    Index first = kNone;  // inner: the first of its two children
    Index item = kNone;   // of a leaf
    Index parent = kNone;
  };

  struct Center;
  void divide(Index node, const std::vector<Item>& items, std::vector<Center>& centers, std::size_t begin,
              std::size_t end);
  void make_leaf(Index node, Index item, const Box& box);
  void add(Index item, const Box& box);
  Box around_children(Index node) const;

  template <class Test>
  bool any_within(Index n, const Vec3& low, const Vec3& high, std::size_t& visited, Test&& test) const {
    const Node& node = nodes_[n];
    ++visited;
    if (!node.overlaps(low, high)) return false;
    if (node.first == kNone) return test(node.item, static_cast<const Box&>(node));
    return any_within(node.first, low, high, visited, test) || any_within(node.first + 1, low, high, visited, test);
  }

  std::vector<Node> nodes_;
  std::vector<Index> leaf_of_;  // of every item
  std::size_t size_ = 0;
};

}  // namespace vmesh
