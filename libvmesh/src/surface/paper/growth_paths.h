#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// The path growth takes through the centerline: a breadth-first tree from a seed node. Tells for every crossing
/// whether it lies at the front of its segment or behind it, which prevents covering vessels twice: where branching
/// nodes crowd together, several fronts may span the same cross-section, and each would grow every daughter.
class GrowthPaths {
 public:
  explicit GrowthPaths(const Centerline& centerline);

  /// Orients the component of `seed` away from it.
  void start_at(Index seed);

  /// +1 when growth runs along `segment` from a to b, -1 when from b to a, 0 when the segment closes a loop.
  int direction(Index segment) const { return direction_[segment]; }

  /// Path length from the seed to the point at `t` of `segment` (mm).
  double depth(Index segment, double t) const;

  /// How far, as a depth, growth has come on `segment`.
  double reached(Index segment) const { return reached_[segment]; }

  /// Notes that growth crosses `segment` at `depth`.
  void advance(Index segment, double depth);

  /// How often growth has crossed `segment`.
  int crossings(Index segment) const { return crossings_[segment]; }

 private:
  const Centerline& centerline_;
  std::vector<int> direction_;
  std::vector<double> start_;  // path length at the segment's near end
  std::vector<double> reached_;
  std::vector<int> crossings_;
  std::vector<char> seen_;  // nodes
};

}  // namespace vmesh
