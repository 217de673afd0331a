#pragma once

#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A maximal chain of segments whose inner nodes have exactly two segments: between nodes that branch or end, or around
/// a loop.
struct Branch {
  std::vector<Index> nodes;     ///< in order; the first and the last are equal when the branch is a loop
  std::vector<Index> segments;  ///< segments[i] joins nodes[i] and nodes[i + 1]
};

/// All branches of `centerline`. Every segment lies on exactly one. In the order of their first nodes, loops without a
/// branching node last; isolated nodes have none.
std::vector<Branch> find_branches(const Centerline& centerline);

/// The same branches, numbered alike, in three arrays: a fraction of the memory where there are millions.
class BranchTable {
 public:
  explicit BranchTable(const Centerline& centerline);

  std::size_t size() const { return offsets_.size() - 1; }
  std::span<const Index> nodes(Index branch) const {
    return {nodes_.data() + offsets_[branch] + branch, nodes_.data() + offsets_[branch + 1] + branch + 1};
  }
  std::span<const Index> segments(Index branch) const {
    return {segments_.data() + offsets_[branch], segments_.data() + offsets_[branch + 1]};
  }

  /// Replaces the number of every segment by `number` of it.
  void renumber_segments(const std::vector<Index>& number);

 private:
  std::vector<Index> offsets_;           // into segments_; a branch has one node more than it has segments
  std::vector<Index> nodes_, segments_;  // of branch after branch
};

}  // namespace vmesh
