#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Finds items near a point, where every item has its own reach. Items of similar reach share a hash grid with cells of
/// about that size, so reaches may differ by orders of magnitude. Items are removed in the reverse order of insertion.
class SphereGrid {
 public:
  /// `largest_reach` > 0: no item reaches farther.
  explicit SphereGrid(double largest_reach) : largest_(largest_reach), slots_(1024) {}

  Index size() const { return static_cast<Index>(items_.size()); }

  /// Adds item number size().
  void push(const Vec3& center, double reach) {
    const int level = level_of(reach);
    if (static_cast<std::size_t>(level) >= level_counts_.size()) level_counts_.resize(level + 1, 0);
    ++level_counts_[level];
    if (2 * used_ > slots_.size()) rehash();
    Slot& slot = find(key(level, center));
    if (slot.head == kNone && !slot.taken) {
      slot.taken = true;
      ++used_;
    }
    items_.push_back({slot.key, slot.head, level});
    slot.head = size() - 1;
  }

  void pop() {
    const Item item = items_.back();
    items_.pop_back();
    find(item.key).head = item.next;
    --level_counts_[item.level];
  }

  /// Calls visit(item) for every item whose centre is within its reach plus `reach` of `p`, and for some others,
  /// provided the item's reach is at least `reach`; with `all`, also for items of smaller reach. Stops when visit
  /// returns false; returns whether it reached the end.
  template <typename Visit>
  bool visit(const Vec3& p, double reach, bool all, const Visit& visit_item) const {
    const int last = all ? static_cast<int>(level_counts_.size()) - 1
                         : std::min(level_of(reach), static_cast<int>(level_counts_.size()) - 1);
    for (int level = 0; level <= last; ++level) {
      if (level_counts_[level] > 0 && !visit_level(p, reach, level, visit_item)) return false;
    }
    return true;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    Index head = kNone;
    bool taken = false;
  };
  struct Item {
    std::uint64_t key;
    Index next;
    int level;
  };

  // Level l holds reaches in (largest / 2^(l+1), largest / 2^l], in cells of twice the larger bound.
  int level_of(double reach) const {
    int level = 0;
    for (double bound = largest_ / 2; reach <= bound && level < 40; bound /= 2) ++level;
    return level;
  }
  double cell_of(int level) const { return std::ldexp(largest_, 1 - level); }

  static std::uint64_t key(int level, std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto part = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x7ffff; };
    return (static_cast<std::uint64_t>(level) << 57) | (part(x) << 38) | (part(y) << 19) | part(z);
  }
  std::uint64_t key(int level, const Vec3& p) const {
    const double cell = cell_of(level);
    return key(level, floor_of(p.x() / cell), floor_of(p.y() / cell), floor_of(p.z() / cell));
  }
  static std::int64_t floor_of(double v) { return static_cast<std::int64_t>(std::floor(v)); }

  std::size_t slot_of(std::uint64_t key) const {
    std::uint64_t h = key * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
    std::size_t i = h & (slots_.size() - 1);
    while (slots_[i].taken && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
    return i;
  }
  Slot& find(std::uint64_t key) {
    Slot& slot = slots_[slot_of(key)];
    slot.key = key;
    return slot;
  }

  void rehash() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.taken) slots_[slot_of(slot.key)] = slot;
    }
  }

  template <typename Visit>
  bool visit_level(const Vec3& p, double reach, int level, const Visit& visit_item) const {
    const double cell = cell_of(level), range = reach + std::ldexp(largest_, -level);
    std::int64_t low[3], high[3];
    for (int d = 0; d < 3; ++d) {
      low[d] = floor_of((p[d] - range) / cell);
      high[d] = floor_of((p[d] + range) / cell);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const Slot& slot = slots_[slot_of(key(level, x, y, z))];
          if (!slot.taken) continue;
          for (Index i = slot.head; i != kNone; i = items_[i].next) {
            if (!visit_item(i)) return false;
          }
        }
      }
    }
    return true;
  }

  double largest_;
  std::vector<Slot> slots_;
  std::vector<Item> items_;
  std::vector<std::size_t> level_counts_;
  std::size_t used_ = 0;
};

}  // namespace vmesh
