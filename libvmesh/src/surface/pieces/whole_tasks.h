#pragma once

#include <atomic>
#include <cstddef>
#include <exception>

#include <tbb/parallel_for.h>

namespace vmesh {

/// tbb::parallel_for over 0 to count - 1 for bodies that contain parallel loops. When a body throws, no more are
/// started, the running ones finish, and the first exception is rethrown. TBB alone would also cancel the loops nested
/// in the other bodies, which would then continue with incomplete results.
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
