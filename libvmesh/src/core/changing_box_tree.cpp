#include "vmesh/core/changing_box_tree.h"

#include <algorithm>

namespace vmesh {

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
  leaf_of_.assign(most + std::size_t{1}, kNone);
  boxes_.resize(leaf_of_.size());
  nodes_.reserve(items.size());
  parents_.reserve(items.size());
  make_root();
  divide(0, items, centers, 0, centers.size());
  // Children come after their parents.
  for (auto n = static_cast<Index>(2 * nodes_.size()); n-- > 0;) {
    if (node(n).first != kNone) static_cast<Bounds&>(node(n)) = around_children(n);
  }
}

void ChangingBoxTree::divide(Index n, const std::vector<Item>& items, std::vector<Center>& centers, std::size_t begin,
                             std::size_t end) {
  const auto at = [&](std::size_t i) { return centers.begin() + static_cast<std::ptrdiff_t>(i); };
  if (end - begin == 1) {
    const auto& [number, box] = items[at(begin)->nth];
    boxes_[number] = box;
    return make_leaf(n, number);
  }
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
  const Index children = add_children(n);
  divide(children, items, centers, begin, half);
  divide(children + 1, items, centers, half, end);
}

void ChangingBoxTree::make_root() {
  nodes_.emplace_back();
  parents_.push_back(kNone);
}

Index ChangingBoxTree::add_children(Index n) {
  const auto children = static_cast<Index>(2 * nodes_.size());
  nodes_.emplace_back();
  parents_.push_back(n);
  node(n).first = children;
  node(n).item = kNone;
  return children;
}

void ChangingBoxTree::make_leaf(Index n, Index item) {
  static_cast<Bounds&>(node(n)) = Bounds(boxes_[item]);
  node(n).first = kNone;
  node(n).item = item;
  leaf_of_[item] = n;
}

void ChangingBoxTree::set(Index item, const Box& box) {
  const bool is_new = !has(item);
  if (item >= boxes_.size()) boxes_.resize(item + std::size_t{1});
  boxes_[item] = box;
  if (is_new) return add(item);
  Index n = leaf_of_[item];
  static_cast<Bounds&>(node(n)) = Bounds(box);
  while ((n = parent(n)) != kNone) {
    const Bounds around = around_children(n);
    if (around == node(n)) return;
    static_cast<Bounds&>(node(n)) = around;
  }
}

// Beside the leaf to which the boxes that must grow the least lead.
void ChangingBoxTree::add(Index item) {
  if (item >= leaf_of_.size()) leaf_of_.resize(item + std::size_t{1}, kNone);
  if (size_++ == 0) {
    if (nodes_.empty()) make_root();
    return make_leaf(0, item);
  }
  const Bounds bounds(boxes_[item]);
  // By how much a box must grow to hold the new one.
  const auto growth = [&](const Bounds& box) {
    const Bounds both = box.joined(bounds);
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (both.high[i] - both.low[i]) - (box.high[i] - box.low[i]);
    return sum;
  };
  Index n = 0;
  while (node(n).first != kNone) {
    static_cast<Bounds&>(node(n)) = node(n).joined(bounds);
    const Index first = node(n).first;
    n = growth(node(first + 1)) < growth(node(first)) ? first + 1 : first;
  }
  const Index beside = node(n).item;
  const Index children = add_children(n);
  make_leaf(children, beside);
  make_leaf(children + 1, item);
  static_cast<Bounds&>(node(n)) = around_children(n);
}

}  // namespace vmesh
