// A slice as runs of equal values, and the components that runs of successive slices form; internal to the module.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vmesh::image {

/// Neighbouring voxels of one label in a row.
struct Run {
  std::size_t first = 0, last = 0;  ///< along the row
  std::size_t label = 0;            ///< a number from 0
  std::size_t set = 0;              ///< of connected runs; for ComponentCounter
};

struct SliceRuns {
  std::vector<Run> runs;             ///< row by row, ascending
  std::vector<std::size_t> row_end;  ///< for every row, the number of runs up to its end

  std::span<const Run> row(std::size_t j) const {
    const std::size_t begin = j == 0 ? 0 : row_end[j - 1];
    return std::span(runs).subspan(begin, row_end[j] - begin);
  }
};

/// Counts the connected components of every label (26 neighbours), in the memory of two slices' runs.
class ComponentCounter {
 public:
  /// The next slice, with as many rows as the others. The runs' sets are ignored.
  void add(SliceRuns slice);

  /// How many components of every label have ended, up to the highest label that has any.
  const std::vector<std::uint64_t>& ended() const { return ended_; }

  /// Ends all; to be called once after the last slice.
  void end();

 private:
  std::size_t root(std::size_t set);
  void unite(std::size_t a, std::size_t b);
  void unite_touching(std::span<const Run> a, std::span<const Run> b);
  void unite_with_neighbours(const SliceRuns& slice);
  void drop_ended(SliceRuns& slice);
  void count(std::size_t label);

  SliceRuns last_;                   ///< its sets are 0 to labels_.size() - 1
  std::vector<std::size_t> labels_;  ///< of every set
  std::vector<std::size_t> parents_;
  std::vector<std::uint64_t> ended_;
};

}  // namespace vmesh::image
