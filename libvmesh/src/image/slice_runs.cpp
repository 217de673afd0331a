#include "slice_runs.h"

#include <algorithm>
#include <limits>

namespace vmesh::image {

std::size_t ComponentCounter::root(std::size_t set) {
  while (parents_[set] != set) set = parents_[set] = parents_[parents_[set]];
  return set;
}

void ComponentCounter::unite(std::size_t a, std::size_t b) {
  a = root(a);
  b = root(b);
  parents_[std::max(a, b)] = std::min(a, b);
}

/// Runs of two rows beside each other, also across corners.
void ComponentCounter::unite_touching(std::span<const Run> a, std::span<const Run> b) {
  std::size_t begin = 0;
  for (const Run& run : a) {
    while (begin < b.size() && b[begin].last + 1 < run.first) ++begin;
    for (std::size_t other = begin; other < b.size() && b[other].first <= run.last + 1; ++other)
      if (b[other].label == run.label) unite(run.set, b[other].set);
  }
}

void ComponentCounter::unite_with_neighbours(const SliceRuns& slice) {
  const std::size_t rows = slice.row_end.size();
  for (std::size_t j = 0; j < rows; ++j) {
    const std::span<const Run> row = slice.row(j);
    if (row.empty()) continue;
    if (j > 0) unite_touching(row, slice.row(j - 1));
    if (last_.row_end.empty()) continue;
    for (std::size_t below = j > 0 ? j - 1 : 0; below < std::min(j + 2, rows); ++below)
      unite_touching(row, last_.row(below));
  }
}

/// Numbers the sets of a slice anew, from 0, and counts those that have no run in it.
void ComponentCounter::drop_ended(SliceRuns& slice) {
  constexpr std::size_t kNoSet = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> numbers(parents_.size(), kNoSet), labels;
  for (Run& run : slice.runs) {
    std::size_t& number = numbers[root(run.set)];
    if (number == kNoSet) {
      number = labels.size();
      labels.push_back(run.label);
    }
    run.set = number;
  }
  for (std::size_t set = 0; set < labels_.size(); ++set)
    if (parents_[set] == set && numbers[set] == kNoSet) count(labels_[set]);
  labels_ = std::move(labels);
}

void ComponentCounter::count(std::size_t label) {
  if (ended_.size() <= label) ended_.resize(label + 1);
  ++ended_[label];
}

void ComponentCounter::add(SliceRuns slice) {
  parents_.resize(labels_.size() + slice.runs.size());
  for (std::size_t set = 0; set < parents_.size(); ++set) parents_[set] = set;
  for (std::size_t r = 0; r < slice.runs.size(); ++r) slice.runs[r].set = labels_.size() + r;
  unite_with_neighbours(slice);
  drop_ended(slice);
  last_ = std::move(slice);
}

void ComponentCounter::end() {
  for (const std::size_t label : labels_) count(label);
  labels_.clear();
  last_ = {};
}

}  // namespace vmesh::image
