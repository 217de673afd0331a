#include "vmesh/core/box_tree.h"

#include <algorithm>

namespace vmesh {

// Twice the box centres are stored beside the numbers, so that partitioning reads memory in order.
struct BoxTree::Item {
  Vec3 middle;
  Index number;
};

BoxTree::BoxTree(const std::vector<Vec3>& low, const std::vector<Vec3>& high)
    : BoxTree(static_cast<Index>(low.size()), [&](Index i) {
        return Box{low[i], high[i]};
      }) {}

BoxTree::BoxTree(Index count, const std::function<Box(Index)>& box_of, Index leaf_size) {
  if (count == 0) return;
  std::vector<Item> items;
  items.reserve(count);
  for (Index i = 0; i < count; ++i) {
    const Box box = box_of(i);
    items.push_back({box.low + box.high, i});
  }
  nodes_.reserve(4 * static_cast<std::size_t>(count) /
                 leaf_size);  // a leaf is more than half full, unless it is the only one
  nodes_.emplace_back();
  divide(0, items, 0, count, leaf_size);
  order_.reserve(count);
  for (const Item& item : items) order_.push_back(item.number);
  // Children come after their parents.
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) enclose(*node, box_of);
}

void BoxTree::divide(Index node, std::vector<Item>& items, Index first, Index count, Index leaf_size) {
  if (count <= leaf_size) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  const auto begin = items.begin() + first;
  Vec3 low = begin->middle, high = low;
  for (auto item = begin; item != begin + count; ++item) {
    low = low.cwiseMin(item->middle);
    high = high.cwiseMax(item->middle);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const Index half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [axis](const Item& i, const Item& j) {
    const double x = i.middle[axis], y = j.middle[axis];
    return x < y || (x == y && i.number < j.number);
  });
  const auto children = static_cast<Index>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  divide(children, items, first, half, leaf_size);
  divide(children + 1, items, first + half, count - half, leaf_size);
}

void BoxTree::enclose(Node& node, const std::function<Box(Index)>& box_of) const {
  if (node.count == 0) {
    const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
    node.low = a.low.cwiseMin(b.low);
    node.high = a.high.cwiseMax(b.high);
    return;
  }
  const Box first = box_of(order_[node.first]);
  node.low = first.low;
  node.high = first.high;
  for (Index i = node.first + 1; i < node.first + node.count; ++i) {
    const Box box = box_of(order_[i]);
    node.low = node.low.cwiseMin(box.low);
    node.high = node.high.cwiseMax(box.high);
  }
}

}  // namespace vmesh
