#include "vmesh/core/box_tree.h"

#include <algorithm>

namespace vmesh {
namespace {

constexpr Index kLeafSize = 4;

}  // namespace

// Twice the box centres are stored beside the numbers, so that partitioning reads memory in order.
struct BoxTree::Item {
  Vec3 middle;
  Index number;
};

BoxTree::BoxTree(const std::vector<Vec3>& low, const std::vector<Vec3>& high)
    : BoxTree(static_cast<Index>(low.size()), [&](Index i) {
        return Box{low[i], high[i]};
      }) {}

BoxTree::BoxTree(Index count, const std::function<Box(Index)>& box_of) {
  if (count == 0) return;
  std::vector<Item> items;
  items.reserve(count);
  for (Index i = 0; i < count; ++i) {
    const Box box = box_of(i);
    items.push_back({box.low + box.high, i});
  }
  nodes_.reserve(count);  // a leaf has at least two items, unless it is the only one
  nodes_.emplace_back();
  divide(0, items, 0, count);
  order_.reserve(count);
  for (const Item& item : items) order_.push_back(item.number);
  // Children come after their parents.
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) enclose(*node, box_of);
}

void BoxTree::divide(Index node, std::vector<Item>& items, Index first, Index count) {
  if (count <= kLeafSize) {
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
  divide(children, items, first, half);
  divide(children + 1, items, first + half, count - half);
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
