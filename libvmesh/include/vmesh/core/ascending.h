#pragma once

#include <algorithm>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Sorts a list and removes duplicates.
template <class T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The middle one of some numbers, the larger of two.
inline double median(std::vector<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// Position of `number` in an ascending list; kNone if it is not there.
inline Index place_in(const std::vector<Index>& list, Index number) {
  const auto it = std::lower_bound(list.begin(), list.end(), number);
  return it != list.end() && *it == number ? static_cast<Index>(it - list.begin()) : kNone;
}

}  // namespace vmesh
