#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "vmesh/core/box_tree.h"

namespace vmesh {

/// Points that are found from places within a reach of their own, for nearest-point queries with conditions.
/// Deterministic.
class PointTree {
 public:
  struct Point {
    Vec3 position;
    double reach;  ///< largest distance at which the point may be found
    Index id;
  };

  explicit PointTree(std::vector<Point> points)
      : points_(std::move(points)),
        tree_(
            static_cast<Index>(points_.size()),
            [this](Index i) {
              const auto& [position, reach, id] = points_[i];
              return BoxTree::Box{position.array() - reach, position.array() + reach};
            },
            kLeafSize) {}

  /// The nearest point within its reach of `p` that `accept(id)` approves; kNone if there is none. At equal distance,
  /// either.
  template <class Accept>
  Index nearest(const Vec3& p, Accept&& accept) const {
    double least = std::numeric_limits<double>::infinity(), limit = 0;
    Index best = kNone;
    tree_.visit(p, limit, [&](Index i) {
      const Point& point = points_[i];
      const double d2 = (point.position - p).squaredNorm();
      if (d2 >= least || d2 > point.reach * point.reach || !accept(point.id)) return;
      least = d2;
      best = point.id;
      if (d2 == 0) limit = -std::numeric_limits<double>::infinity();  // there is none nearer
    });
    return best;
  }

 private:
  static constexpr Index kLeafSize = 8;

  std::vector<Point> points_;
  BoxTree tree_;  // of the points' reaches
};

}  // namespace vmesh
