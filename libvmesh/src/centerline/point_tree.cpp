#include "point_tree.h"

#include <algorithm>
#include <tuple>

namespace vmesh {
namespace {

constexpr Index kLeafSize = 8;

}  // namespace

PointTree::PointTree(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty()) return;
  boxes_.reserve(points_.size() / 2 + 2);
  boxes_.emplace_back();
  fill(0, 0, static_cast<Index>(points_.size()));
}

void PointTree::fill(Index index, Index first, Index last) {
  Box box;
  box.first = first;
  box.last = last;
  box.low = box.high = points_[first].position;
  for (Index i = first; i < last; ++i) {
    box.low = box.low.cwiseMin(points_[i].position);
    box.high = box.high.cwiseMax(points_[i].position);
    box.reach = std::max(box.reach, points_[i].reach);
  }
  if (last - first > kLeafSize) {
    box.children = static_cast<Index>(boxes_.size());
    boxes_.resize(boxes_.size() + 2);
  }
  boxes_[index] = box;
  if (box.children == 0) return;
  Eigen::Index axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const Index middle = first + (last - first) / 2;
  std::nth_element(points_.begin() + first, points_.begin() + middle, points_.begin() + last,
                   [axis](const Point& a, const Point& b) {
                     return std::tie(a.position[axis], a.id) < std::tie(b.position[axis], b.id);
                   });
  fill(box.children, first, middle);
  fill(box.children + 1, middle, last);
}

void PointTree::set_labels(const std::vector<Index>& label_of_id) {
  labels_.resize(points_.size());
  for (Index i = 0; i < points_.size(); ++i) labels_[i] = label_of_id[points_[i].id];
  // Children come after their parent.
  for (std::size_t b = boxes_.size(); b-- > 0;) {
    Box& box = boxes_[b];
    if (box.children == 0) {
      box.label = labels_[box.first];
      for (Index i = box.first; i < box.last; ++i) {
        if (labels_[i] != box.label) box.label = kNone;
      }
    } else {
      const Index left = boxes_[box.children].label, right = boxes_[box.children + 1].label;
      box.label = left == right ? left : kNone;
    }
  }
}

}  // namespace vmesh
