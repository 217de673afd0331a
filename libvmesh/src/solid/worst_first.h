#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Numbers of cells, below `count`, with a shape below `good`, worst first.
template <class Shape>
std::vector<Index> worst_first(std::size_t count, double good, const Shape& shape) {
  std::vector<std::pair<double, Index>> bad;
  for (Index c = 0; c < count; ++c) {
    const double found = shape(c);
    if (found < good) bad.emplace_back(found, c);
  }
  std::sort(bad.begin(), bad.end());
  std::vector<Index> cells;
  cells.reserve(bad.size());
  for (const auto& [found, c] : bad) cells.push_back(c);
  return cells;
}

}  // namespace vmesh
