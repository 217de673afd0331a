#pragma once

#include "blocked_range.h"
#include "partitioner.h"

namespace tbb {

template <class Number, class Body>
void parallel_for(Number first, Number last, const Body& body, const simple_partitioner& = {}) {
  for (Number i = first; i < last; ++i) body(i);
}

/// Halves the range down to its grain, as oneTBB does with this partitioner: what a task passes on stays the same.
template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body, const simple_partitioner& partitioner) {
  if (range.empty()) return;
  if (!range.is_divisible()) return body(range);
  const Value middle = range.begin() + (range.end() - range.begin()) / 2;
  parallel_for(blocked_range<Value>(range.begin(), middle, range.grainsize()), body, partitioner);
  parallel_for(blocked_range<Value>(middle, range.end(), range.grainsize()), body, partitioner);
}

/// All at once.
template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  if (!range.empty()) body(range);
}

}  // namespace tbb
