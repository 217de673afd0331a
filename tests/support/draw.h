#pragma once

#include <random>
#include <utility>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::testing {

/// Random numbers that are the same on every machine: the standard fixes the generator, not its distributions.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : bits_(seed) {}

  /// In [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(static_cast<std::uint32_t>(bits_())) * 0x1p-32);
  }
  /// In [0, count).
  Index below(Index count) {
    return static_cast<Index>(std::uint64_t{static_cast<std::uint32_t>(bits_())} * count >> 32);
  }
  bool chance(double probability) { return uniform(0, 1) < probability; }

  Vec3 in_cube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_cube(1);
      if (p.norm() > 0.1 && p.norm() <= 1) return p.normalized();
    }
  }
  /// A unit vector at right angles to `axis`.
  Vec3 across(const Vec3& axis) {
    for (;;) {
      const Vec3 p = direction().cross(axis.normalized());
      if (p.norm() > 0.1) return p.normalized();
    }
  }

  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(static_cast<Index>(i))]);
  }

 private:
  std::mt19937 bits_;
};

}  // namespace vmesh::testing
