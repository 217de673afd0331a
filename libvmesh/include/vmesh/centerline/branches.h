#pragma once

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

}  // namespace vmesh
