#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "vmesh/quality/closest_point.h"

namespace vmesh::fitting {

/// Goes over a surface from face `start`, across edges, to where no face beside is nearer to `p`: to a locally closest
/// point, in a fraction of the time that the closest of all takes if the start is near. nullopt if the way is long.
/// `across(f)`: the faces across the edges of face f, kNone at a border.
template <class Across>
std::optional<ClosestPoint> walk_closer(const ClosestPointIndex& index, const Vec3& p, Index start, Across&& across) {
  constexpr double kSame = 1 + 1e-9;    // faces that share the closest point
  constexpr std::size_t kLongest = 48;  // faces seen on the way
  std::array<Index, kLongest> seen;
  std::size_t count = 0;
  seen[count++] = start;
  Index nearest = start;
  double least = index.squared_distance(start, p);
  for (std::size_t i = 0; i < count; ++i) {
    for (const Index next : across(seen[i])) {
      if (next == kNone || std::find(seen.begin(), seen.begin() + count, next) != seen.begin() + count) continue;
      const double squared = index.squared_distance(next, p);
      if (!(squared <= kSame * least)) continue;
      if (count == kLongest) return std::nullopt;
      seen[count++] = next;
      if (squared * kSame < least) i = count - 2;  // goes on from there
      if (squared < least) {
        least = squared;
        nearest = next;
      }
    }
  }
  return index.closest_on(nearest, p);
}

}  // namespace vmesh::fitting
