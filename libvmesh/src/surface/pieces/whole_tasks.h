#pragma once

#include <atomic>
#include <cstddef>
#include <exception>

#include <tbb/parallel_for.h>

namespace vmesh {

/// tbb::parallel_for over 0 to count - 1 for bodies that have parallel loops of their own. When one throws, no others
/// are begun, those that were are left to end, and then what was thrown first is thrown. By itself, TBB would cancel
/// the loops within the others, too, which would then go on with half of what these were to fill in.
template <class Body>
void for_whole_tasks(std::size_t count, const Body& body) {
  std::atomic<bool> thrown = false;
  std::exception_ptr first;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    if (thrown) return;
    try {
      body(i);
    } catch (...) {
      if (!thrown.exchange(true)) first = std::current_exception();
    }
  });
  if (first) std::rethrow_exception(first);
}

}  // namespace vmesh
