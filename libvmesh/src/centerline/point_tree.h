#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// A k-d tree over a subset of a list of points, for nearest-point queries with conditions. Deterministic.
class PointTree {
 public:
  struct Point {
    Vec3 position;
    double reach;  ///< largest distance at which the point may be found
    Index id;
  };

  explicit PointTree(std::vector<Point> points);

  /// Gives every point a label (by id), so that subtrees with a single label can be skipped as a whole.
  void set_labels(const std::vector<Index>& label_of_id);

  /// The nearest point within its reach of `p` whose label is not `skip_label` and that `accept(id)` approves; kNone if
  /// there is none. At equal distance, either.
  template <class Accept>
  Index nearest(const Vec3& p, Index skip_label, Accept&& accept) const {
    Best best;
    if (!boxes_.empty()) search(0, p, skip_label, accept, best);
    return best.id;
  }

 private:
  struct Box {
    Vec3 low, high;
    double reach = 0;     // largest of the points
    Index label = kNone;  // of all points, or kNone when they differ
    Index first = 0, last = 0;
    Index children = 0;  // of the first child; the second follows; 0 for a leaf
  };
  struct Best {
    double distance2 = std::numeric_limits<double>::infinity();
    Index id = kNone;
  };

  void fill(Index box, Index first, Index last);
  static double distance2(const Box& box, const Vec3& p) {
    return (box.low - p).cwiseMax(p - box.high).cwiseMax(0.0).squaredNorm();
  }

  template <class Accept>
  void search(Index index, const Vec3& p, Index skip_label, Accept& accept, Best& best) const {
    const Box& box = boxes_[index];
    const double d2 = distance2(box, p);
    if (d2 >= best.distance2 || d2 > box.reach * box.reach) return;
    if (box.label != kNone && box.label == skip_label) return;
    if (box.children == 0) {
      for (Index i = box.first; i < box.last; ++i) {
        const Point& point = points_[i];
        const double point_d2 = (point.position - p).squaredNorm();
        if (point_d2 >= best.distance2 || point_d2 > point.reach * point.reach) continue;
        if (!labels_.empty() && labels_[i] == skip_label) continue;
        if (accept(point.id)) best = {point_d2, point.id};
      }
      return;
    }
    Index near = box.children, far = box.children + 1;
    if (distance2(boxes_[far], p) < distance2(boxes_[near], p)) std::swap(near, far);
    search(near, p, skip_label, accept, best);
    search(far, p, skip_label, accept, best);
  }

  std::vector<Point> points_;
  std::vector<Box> boxes_;
  std::vector<Index> labels_;  // by position in points_
};

}  // namespace vmesh
