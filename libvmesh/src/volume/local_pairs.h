#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// The gap between two spheres of the vessel volume up to which they touch: so many radii of the smaller and so many of
/// the larger one.
struct Touch {
  double smaller, larger;

  double gap(double r, double q) const { return std::max(smaller * std::min(r, q), (smaller - 0.4) * std::min(r, q) + larger * std::max(r, q)); }
};

/// Up to this gap vessels that part count as one volume: the default rounding at branches fills what is between them
/// (VesselField: opposite walls meet where the gap is `blend` smaller radii). Spheres half a radius apart stand for
/// them, between which the larger's wall recedes by 1 - sqrt(1 - 0.25^2) = 0.032 radii.
inline constexpr Touch kOneVolume{0.5, 0.04};

/// A growing symmetric relation between indices. Rows rather than a hash table: indices that are used one after the
/// other are near each other in memory.
class PairSet {
 public:
  bool insert(Index i, Index j) {
    const auto [low, high] = std::minmax(i, j);
    if (low >= above_.size()) above_.resize(low + 1);
    std::vector<Index>& row = above_[low];
    const auto place = std::lower_bound(row.begin(), row.end(), high);
    if (place != row.end() && *place == high) return false;
    row.insert(place, high);
    pairs_.emplace_back(low, high);
    return true;
  }
  bool contains(Index i, Index j) const {
    const auto [low, high] = std::minmax(i, j);
    return low < above_.size() && std::binary_search(above_[low].begin(), above_[low].end(), high);
  }
  /// In the order of insertion, each with the lower index first.
  const std::vector<std::pair<Index, Index>>& pairs() const { return pairs_; }

 private:
  std::vector<std::vector<Index>> above_;  // of every index its greater partners, ascending
  std::vector<std::pair<Index, Index>> pairs_;
};

/// The pairs of segments that are local to each other: a pair of spheres, one on each, can be reached from a pair of
/// one and the same by moving either along the centerline without losing touch. Spheres half a mean radius apart stand
/// for a segment.
PairSet local_pairs(const Centerline& centerline, const Touch& touch);

}  // namespace vmesh
