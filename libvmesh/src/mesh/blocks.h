#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

namespace vmesh {

/// Calls body(begin, end) for consecutive blocks of 0 to count - 1, which are the same for any number of threads, and
/// returns the results in their order. Isolated: a thread that waits for others does not start on a piece of a growing
/// surface.
template <class Result, class Body>
std::vector<Result> of_blocks(std::size_t count, const Body& body) {
  constexpr std::size_t kBlock = 1 << 14;
  std::vector<Result> results((count + kBlock - 1) / kBlock);
  const auto one = [&](std::size_t b) { results[b] = body(b * kBlock, std::min(count, (b + 1) * kBlock)); };
  if (results.size() == 1) {
    one(0);
  } else if (results.size() > 1) {
    tbb::this_task_arena::isolate(
        [&] { tbb::parallel_for(std::size_t{0}, results.size(), one, tbb::simple_partitioner()); });
  }
  return results;
}

/// The same without results.
template <class Body>
void for_blocks(std::size_t count, const Body& body) {
  of_blocks<char>(count, [&](std::size_t begin, std::size_t end) {
    body(begin, end);
    return char{};
  });
}

/// One list after the other.
template <class T>
std::vector<T> joined_lists(const std::vector<std::vector<T>>& lists) {
  std::size_t size = 0;
  for (const std::vector<T>& list : lists) size += list.size();
  std::vector<T> all;
  all.reserve(size);
  for (const std::vector<T>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace vmesh
