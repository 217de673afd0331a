#include "vmesh/centerline/branches.h"

namespace vmesh {
namespace {

class BranchFinder {
 public:
  explicit BranchFinder(const Centerline& centerline)
      : centerline_(centerline), found_(centerline.segments().size(), 0) {}

  std::vector<Branch> run() {
    for (Index n = 0; n < centerline_.nodes().size(); ++n) {
      if (centerline_.degree(n) != 2) follow_all(n);
    }
    for (Index n = 0; n < centerline_.nodes().size(); ++n) follow_all(n);  // loops without a branching node
    return std::move(branches_);
  }

 private:
  void follow_all(Index node) {
    for (const Index s : centerline_.incident_segments(node)) {
      if (!found_[s]) follow(node, s);
    }
  }

  void follow(Index node, Index segment) {
    Branch branch;
    branch.nodes.push_back(node);
    while (segment != kNone) {
      found_[segment] = 1;
      node = centerline_.other_node(segment, node);
      branch.segments.push_back(segment);
      branch.nodes.push_back(node);
      segment = next_segment(node);
    }
    branches_.push_back(std::move(branch));
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
  std::vector<Branch> branches_;
};

}  // namespace

std::vector<Branch> find_branches(const Centerline& centerline) { return BranchFinder(centerline).run(); }

}  // namespace vmesh
