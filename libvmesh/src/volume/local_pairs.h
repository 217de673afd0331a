#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// Sums of radii within which two spheres of the vessel volume touch, or blend.
inline constexpr double kTouch = 1.25;

/// A growing symmetric relation between indices.
class PairSet {
 public:
  bool insert(Index i, Index j) {
    if (!known_.insert(key(i, j)).second) return false;
    pairs_.push_back(std::minmax(i, j));
    return true;
  }
  bool contains(Index i, Index j) const { return known_.contains(key(i, j)); }
  const std::vector<std::pair<Index, Index>>& pairs() const { return pairs_; }

 private:
  static std::uint64_t key(Index i, Index j) { return std::uint64_t{std::min(i, j)} << 32 | std::max(i, j); }

  std::unordered_set<std::uint64_t> known_;
  std::vector<std::pair<Index, Index>> pairs_;
};

/// The pairs of segments that are local to each other: a pair of spheres, one on each, can be reached from a pair of
/// one and the same by moving either along the centerline without losing touch. Spheres half a mean radius apart stand
/// for a segment; two touch within `touch` times the sum of their radii.
PairSet local_pairs(const Centerline& centerline, double touch);

}  // namespace vmesh
