#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

#include "volume/fans.h"

namespace vmesh {

/// The gap between two spheres of the vessel volume up to which they touch: a multiple of the smaller radius, or, where
/// the radii are very different, kSlack smaller radii plus a multiple of the larger one.
struct Touch {
  // Derived: the largest gap required of vessels that part (contact_pairs.cpp); safe 0.28 to 0.48, above slower.
  static constexpr double kSlack = 0.4;

  double smaller, larger;

  double gap(double r, double q) const {
    const auto [low, high] = std::minmax(r, q);
    return std::max(smaller * low, (smaller + kSlack - 0.5) * low + larger * high);
  }
};

/// Up to this gap vessels that part count as one volume: the rounding at branches fills the space between them
/// (VesselField: opposite walls meet where the gap is `blend` smaller radii). A larger one would hide a gap that stays
/// open: the volume would have a tunnel that the graph lacks. Vessels are represented by spheres, between which the
/// larger one's wall recedes: where they are half a radius apart, by 1 - sqrt(1 - 0.25^2) = 0.032 radii. A little more
/// than that is allowed where one vessel is less than two fifths of the other.
inline Touch one_volume(double blend) {
  constexpr double kLeast = 0.1;    // so that the default gap between vessels may be less
  constexpr double kLargest = 0.5;  // the default blend
  const double gap = std::clamp(blend, kLeast, kLargest);
  return {gap, 0.08 * gap};
}

/// Mean radii between two spheres that represent a cone, so that the wall recedes between them by a fixed share of the
/// gap that is looked for; safe 0.35 to 0.7 at 0.5.
inline double sphere_spacing(const Touch& touch) { return 0.5 * std::sqrt(std::min(1.0, touch.smaller / 0.5)); }

/// Up to this gap vessels that have parted have come near again, and no more is required of vessels that part. On
/// vessel_portal, whose hairpin has a gap of 0.42, the mean error is 3 % larger with 1 instead of 0.8.
inline Touch near_again(double blend) { return {0.8 * one_volume(blend).smaller, one_volume(blend).larger}; }

/// Spheres farther from each other than this are not local to each other: opposite walls are rounded over a gap of
/// 2 * blend smaller radii.
inline Touch farthest_local(double blend) { return {std::max(0.5, 2 * blend), 0.04}; }

/// A growing symmetric relation between indices. Rows rather than one hash table, so that indices used in turn are near
/// each other in memory. Short rows are sorted; long ones, as around a node of many branches, are hash tables.
class PairSet {
 public:
  PairSet() = default;
  /// For indices below `count`.
  explicit PairSet(std::size_t count) { above_.reserve(count); }

  bool insert(Index i, Index j) {
    const auto [low, high] = std::minmax(i, j);
    if (low >= above_.size()) above_.resize(low + 1);
    if (!above_[low].insert(high)) return false;
    pairs_.emplace_back(low, high);
    return true;
  }
  bool contains(Index i, Index j) const {
    const auto [low, high] = std::minmax(i, j);
    return low < above_.size() && above_[low].contains(high);
  }
  /// In the order of insertion, each with the lower index first.
  const std::deque<std::pair<Index, Index>>& pairs() const { return pairs_; }

 private:
  class Row {
   public:
    bool insert(Index i) {
      if (is_table()) return insert_hashed(i);
      const auto place = std::lower_bound(slots_.begin(), slots_.end(), i);
      if (place != slots_.end() && *place == i) return false;
      slots_.insert(place, i);
      if (++count_ > kLongestSorted) rehash(4 * kLongestSorted);
      return true;
    }
    bool contains(Index i) const {
      return is_table() ? slots_[slot_of(i)] == i : std::binary_search(slots_.begin(), slots_.end(), i);
    }

   private:
    // Measured on tree1560: sorting longer rows costs more; safe 64 to 90, below slower.
    static constexpr Index kLongestSorted = 64;

    bool is_table() const { return count_ > kLongestSorted; }
    bool insert_hashed(Index i) {
      Index& slot = slots_[slot_of(i)];
      if (slot == i) return false;
      slot = i;
      if (2 * ++count_ > slots_.size()) rehash(2 * slots_.size());
      return true;
    }
    // The slot that holds `i`, or a free one for it.
    std::size_t slot_of(Index i) const {
      const std::size_t mask = slots_.size() - 1;
      std::size_t slot = (i * std::uint64_t{0x9E3779B97F4A7C15} >> 32) & mask;
      while (slots_[slot] != i && slots_[slot] != kNone) slot = (slot + 1) & mask;
      return slot;
    }
    // Moves into a table of this size, a power of two.
    void rehash(std::size_t size) {
      std::vector<Index> old(size, kNone);
      std::swap(old, slots_);
      for (const Index i : old) {
        if (i != kNone) slots_[slot_of(i)] = i;
      }
    }

    std::vector<Index> slots_;
    Index count_ = 0;
  };

  std::vector<Row> above_;                     // for every index, its greater partners
  std::deque<std::pair<Index, Index>> pairs_;  // a deque, as they are many: growing must not copy them
};

/// Pairs of segments: those in one fan, and others.
struct LocalSegments {
  Fans fans;
  PairSet others;

  bool contains(Index i, Index j) const { return fans.are_in_one(i, j) || others.contains(i, j); }
};

/// The pairs of segments that are local to each other: starting from two copies of one sphere and moving either along
/// the centerline without losing touch, a pair of spheres with one on each segment can be reached. A segment is
/// represented by spheres half a mean radius apart.
LocalSegments local_pairs(const Centerline& centerline, const Touch& touch);

}  // namespace vmesh
