#include "vmesh/core/changing_box_tree.h"

#include <algorithm>

namespace vmesh {
namespace {

BoxTree::Box joined(const BoxTree::Box& a, const BoxTree::Box& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

// By how much a box must grow to hold another.
double growth(const BoxTree::Box& box, const BoxTree::Box& other) {
  const BoxTree::Box both = joined(box, other);
  return (both.high - both.low).sum() - (box.high - box.low).sum();
}

}  // namespace

// Twice the centre of an item's box.
struct ChangingBoxTree::Center {
  Vec3 middle;
  Index nth;
};

ChangingBoxTree::ChangingBoxTree(const std::vector<Item>& items) : size_(items.size()) {
  if (items.empty()) return;
  Index most = 0;
  std::vector<Center> centers;
  centers.reserve(items.size());
  for (Index i = 0; i < items.size(); ++i) {
    most = std::max(most, items[i].number);
    centers.push_back({items[i].box.low + items[i].box.high, i});
  }
  leaf_of_.assign(most + 1, kNone);
  nodes_.reserve(2 * items.size());
  nodes_.emplace_back();
  divide(0, items, centers, 0, centers.size());
  // Children come after their parents.
  for (auto n = static_cast<Index>(nodes_.size()); n-- > 0;) {
    if (nodes_[n].first != kNone) static_cast<Box&>(nodes_[n]) = around_children(n);
  }
}

void ChangingBoxTree::divide(Index node, const std::vector<Item>& items, std::vector<Center>& centers,
                             std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t i) { return centers.begin() + static_cast<std::ptrdiff_t>(i); };
  if (end - begin == 1) return make_leaf(node, items[at(begin)->nth].number, items[at(begin)->nth].box);
  Vec3 low = at(begin)->middle, high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin(at(i)->middle);
    high = high.cwiseMax(at(i)->middle);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(half), at(end), [axis](const Center& i, const Center& j) {
    const double x = i.middle[axis], y = j.middle[axis];
    return x < y || (x == y && i.nth < j.nth);
  });
  const auto children = static_cast<Index>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  nodes_[children].parent = nodes_[children + 1].parent = node;
  divide(children, items, centers, begin, half);
  divide(children + 1, items, centers, half, end);
}

void ChangingBoxTree::make_leaf(Index node, Index item, const Box& box) {
  static_cast<Box&>(nodes_[node]) = box;
  nodes_[node].first = kNone;
  nodes_[node].item = item;
  leaf_of_[item] = node;
}

ChangingBoxTree::Box ChangingBoxTree::around_children(Index node) const {
  return joined(nodes_[nodes_[node].first], nodes_[nodes_[node].first + 1]);
}

void ChangingBoxTree::set(Index item, const Box& box) {
  if (!has(item)) return add(item, box);
  Index node = leaf_of_[item];
  static_cast<Box&>(nodes_[node]) = box;
  while ((node = nodes_[node].parent) != kNone) {
    const Box around = around_children(node);
    if (around.low == nodes_[node].low && around.high == nodes_[node].high) return;
    static_cast<Box&>(nodes_[node]) = around;
  }
}

// Beside the leaf to which the boxes that must grow the least lead.
void ChangingBoxTree::add(Index item, const Box& box) {
  if (item >= leaf_of_.size()) leaf_of_.resize(item + 1, kNone);
  ++size_;
  if (nodes_.empty()) {
    nodes_.emplace_back();
    return make_leaf(0, item, box);
  }
  Index node = 0;
  while (nodes_[node].first != kNone) {
    static_cast<Box&>(nodes_[node]) = joined(nodes_[node], box);
    const Index first = nodes_[node].first;
    node = growth(nodes_[first + 1], box) < growth(nodes_[first], box) ? first + 1 : first;
  }
  const auto children = static_cast<Index>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[children].parent = nodes_[children + 1].parent = node;
  make_leaf(children, nodes_[node].item, nodes_[node]);
  make_leaf(children + 1, item, box);
  nodes_[node].first = children;
  nodes_[node].item = kNone;
  static_cast<Box&>(nodes_[node]) = around_children(node);
}

}  // namespace vmesh
