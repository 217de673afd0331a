#include "vmesh/centerline/branches.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

Centerline graph(Index nodes, std::vector<CenterlineSegment> segments) {
  std::vector<CenterlineNode> list;
  for (Index n = 0; n < nodes; ++n) list.push_back({{double(n), double(n * n), 0}, 1});
  return {std::move(list), std::move(segments)};
}

void expect_chain(const Centerline& centerline, const Branch& branch) {
  ASSERT_EQ(branch.nodes.size(), branch.segments.size() + 1);
  for (std::size_t i = 0; i < branch.segments.size(); ++i) {
    EXPECT_EQ(centerline.other_node(branch.segments[i], branch.nodes[i]), branch.nodes[i + 1]);
  }
}

TEST(Branches, RunBetweenNodesThatBranchOrEnd) {
  const Centerline fork = graph(7, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {5, 2}, {6, 5}});
  const auto branches = find_branches(fork);
  ASSERT_EQ(branches.size(), 3u);
  EXPECT_EQ(branches[0].nodes, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(branches[1].nodes, (std::vector<Index>{2, 3, 4}));
  EXPECT_EQ(branches[2].nodes, (std::vector<Index>{2, 5, 6}));
  for (const Branch& branch : branches) expect_chain(fork, branch);
}

TEST(Branches, OfARingIsOneThatReturns) {
  const Centerline ring = graph(4, {{0, 1}, {1, 2}, {3, 2}, {3, 0}});
  const auto branches = find_branches(ring);
  ASSERT_EQ(branches.size(), 1u);
  EXPECT_EQ(branches[0].segments.size(), 4u);
  EXPECT_EQ(branches[0].nodes.front(), branches[0].nodes.back());
  expect_chain(ring, branches[0]);
}

TEST(Branches, LeaveAndReturnToABranchingNode) {
  const Centerline loop = graph(4, {{0, 1}, {1, 2}, {2, 3}, {3, 1}});
  const auto branches = find_branches(loop);
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[1].nodes.front(), 1u);
  EXPECT_EQ(branches[1].nodes.back(), 1u);
  EXPECT_EQ(branches[1].segments.size(), 3u);
}

TEST(Branches, CoverEverySegmentOnceInAnyGraph) {
  const Centerline mixed =
      graph(12, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {4, 6}, {6, 7}, {7, 4}, {8, 9}, {9, 10}});  // 11 alone
  std::vector<int> seen(mixed.segments().size(), 0);
  for (const Branch& branch : find_branches(mixed)) {
    expect_chain(mixed, branch);
    for (const Index s : branch.segments) ++seen[s];
    for (std::size_t i = 1; i + 1 < branch.nodes.size(); ++i) EXPECT_EQ(mixed.degree(branch.nodes[i]), 2u);
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST(BranchTable, HoldsTheSameBranches) {
  const Centerline mixed =
      graph(12, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {4, 6}, {6, 7}, {7, 4}, {8, 9}, {9, 10}});  // 11 alone
  BranchTable table(mixed);
  // One from 3 and two at 4, the chain from 8, and the ring.
  ASSERT_EQ(table.size(), 5u);
  EXPECT_TRUE(std::ranges::equal(table.nodes(1), std::vector<Index>{4, 5}));
  EXPECT_TRUE(std::ranges::equal(table.segments(1), std::vector<Index>{4}));
  EXPECT_TRUE(std::ranges::equal(table.nodes(4), std::vector<Index>{0, 1, 2, 0}));
  const auto branches = find_branches(mixed);
  ASSERT_EQ(branches.size(), table.size());
  std::vector<Index> doubled;
  for (Index s = 0; s < mixed.segments().size(); ++s) doubled.push_back(2 * s);
  for (Index b = 0; b < table.size(); ++b) {
    EXPECT_TRUE(std::ranges::equal(table.nodes(b), branches[b].nodes));
    EXPECT_TRUE(std::ranges::equal(table.segments(b), branches[b].segments));
  }
  table.renumber_segments(doubled);
  EXPECT_TRUE(std::ranges::equal(table.segments(1), std::vector<Index>{8}));
}

}  // namespace
}  // namespace vmesh
