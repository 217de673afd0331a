#include "vmesh/centerline/branches.h"

namespace vmesh {
namespace {

// Follows branches from node to node, and appends them to three arrays.
class BranchFinder {
 public:
  BranchFinder(const Centerline& centerline, std::vector<Index>& offsets, std::vector<Index>& nodes,
               std::vector<Index>& segments)
      : centerline_(centerline),
        found_(centerline.segments().size(), 0),
        offsets_(offsets),
        nodes_(nodes),
        segments_(segments) {}

  void run() {
    segments_.reserve(found_.size());
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      if (centerline_.degree(n) != 2) follow_all(n);
    }
    for (Index n = 0; n < centerline_.nodes().size(); ++n) follow_all(n);  // loops without a branching node
    offsets_.push_back(static_cast<Index>(segments_.size()));
  }

 private:
  void follow_all(Index node) {
    for (const Index s : centerline_.incident_segments(node)) {
      if (!found_[s]) follow(node, s);
    }
  }

  void follow(Index node, Index segment) {
    offsets_.push_back(static_cast<Index>(segments_.size()));
    nodes_.push_back(node);
    while (segment != kNone) {
      found_[segment] = 1;
      node = centerline_.other_node(segment, node);
      segments_.push_back(segment);
      nodes_.push_back(node);
      segment = next_segment(node);
    }
  }

  // The other segment of an inner node; none at the end of a branch.
  Index next_segment(Index node) const {
    if (centerline_.degree(node) != 2) return kNone;
    for (const Index s : centerline_.incident_segments(node)) {
      if (!found_[s]) return s;
    }
    return kNone;
  }

  const Centerline& centerline_;
  std::vector<char> found_;
  std::vector<Index>&offsets_, &nodes_, &segments_;
};

}  // namespace

BranchTable::BranchTable(const Centerline& centerline) { BranchFinder(centerline, offsets_, nodes_, segments_).run(); }

void BranchTable::renumber_segments(const std::vector<Index>& number) {
  for (Index& s : segments_) s = number[s];
}

std::vector<Branch> find_branches(const Centerline& centerline) {
  const BranchTable table(centerline);
  std::vector<Branch> branches(table.size());
  for (Index b = 0; b < branches.size(); ++b) {
    const auto nodes = table.nodes(b), segments = table.segments(b);
    branches[b] = {{nodes.begin(), nodes.end()}, {segments.begin(), segments.end()}};
  }
  return branches;
}

}  // namespace vmesh
