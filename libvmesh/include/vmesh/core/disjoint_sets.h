#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Union-find over the numbers 0 to count - 1; each starts in a set of its own. A set is represented by its lowest
/// number, whatever the order in which sets were joined.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  /// The lowest number of the set that contains `i`.
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Returns whether they were in different sets.
  bool join(Index i, Index j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
    return i != j;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace vmesh
