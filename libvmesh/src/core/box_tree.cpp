#include "vmesh/core/box_tree.h"

#include <algorithm>
#include <numeric>

namespace vmesh {
namespace {

constexpr Index kLeafSize = 4;

}  // namespace

BoxTree::BoxTree(const std::vector<Vec3>& low, const std::vector<Vec3>& high) {
  if (low.empty()) return;
  order_.resize(low.size());
  std::iota(order_.begin(), order_.end(), Index{0});
  nodes_.emplace_back();
  build(0, 0, static_cast<Index>(low.size()), low, high);
}

void BoxTree::build(Index node, Index first, Index count, const std::vector<Vec3>& low, const std::vector<Vec3>& high) {
  Vec3 box_low = low[order_[first]], box_high = high[order_[first]];
  Vec3 mid_low = box_low + box_high, mid_high = mid_low;
  for (Index i = first; i < first + count; ++i) {
    const Vec3 mid = low[order_[i]] + high[order_[i]];
    box_low = box_low.cwiseMin(low[order_[i]]);
    box_high = box_high.cwiseMax(high[order_[i]]);
    mid_low = mid_low.cwiseMin(mid);
    mid_high = mid_high.cwiseMax(mid);
  }
  nodes_[node].low = box_low;
  nodes_[node].high = box_high;
  if (count <= kLeafSize) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  int axis = 0;
  (mid_high - mid_low).maxCoeff(&axis);
  const Index half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](Index i, Index j) {
    const double x = low[i][axis] + high[i][axis], y = low[j][axis] + high[j][axis];
    return x < y || (x == y && i < j);
  });
  const auto children = static_cast<Index>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  build(children, first, half, low, high);
  build(children + 1, first + half, count - half, low, high);
}

}  // namespace vmesh
