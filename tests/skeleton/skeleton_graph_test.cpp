#include "skeleton/skeleton_graph.h"

#include <gtest/gtest.h>

#include "skeleton/loop_necks.h"

namespace vmesh::skeleton {
namespace {

/// A line along x of `count` nodes 1 mm apart, all of `radius`.
Graph line(Index count, double radius) {
  Graph graph;
  for (Index n = 0; n < count; ++n) {
    graph.nodes.push_back({Vec3(n, 0, 0), radius});
    if (n > 0) graph.edges.push_back({n - 1, n});
  }
  return graph;
}

TEST(Chains, RunBetweenNodesThatBranchOrEnd) {
  Graph graph = line(7, 1);
  graph.nodes.push_back({Vec3(3, 1, 0), 1});
  graph.edges.push_back({3, 7});
  const std::vector<Chain> chains = chains_of(graph);
  ASSERT_EQ(chains.size(), 3u);
  for (const Chain& chain : chains) EXPECT_EQ(chain.nodes.size(), chain.edges.size() + 1);
}

TEST(Chains, ALoopIsOne) {
  Graph graph = line(5, 1);
  graph.edges.push_back({4, 0});
  const std::vector<Chain> chains = chains_of(graph);
  ASSERT_EQ(chains.size(), 1u);
  EXPECT_EQ(chains[0].nodes.front(), chains[0].nodes.back());
  EXPECT_EQ(chains[0].edges.size(), 5u);
}

TEST(PruneSpurs, RemovesWhatIsShorterThanTheRadius) {
  Graph graph = line(21, 3);
  graph.nodes.push_back({Vec3(10, 2.9, 0), 1});
  graph.edges.push_back({10, 21});
  graph.nodes.push_back({Vec3(5, 3.1, 0), 1});
  graph.edges.push_back({5, 22});
  EXPECT_EQ(prune_spurs(graph), 1u);
  EXPECT_EQ(graph.edges.size(), 21u);
  EXPECT_EQ(graph.nodes.size(), 22u);
}

TEST(PruneSpurs, LeavesALineAlone) {
  Graph graph = line(3, 10);
  EXPECT_EQ(prune_spurs(graph), 0u);
}

TEST(BreakLoops, KeepsTheLongest) {
  Graph graph = line(20, 1);
  graph.edges.push_back({19, 0});
  graph.nodes.push_back({Vec3(3, 0.5, 0), 1});  // a triangle over edge 3 - 4
  graph.edges.push_back({3, 20});
  graph.edges.push_back({20, 4});
  EXPECT_EQ(break_loops(graph, 2), 0u);
  EXPECT_EQ(break_loops(graph, 1), 1u);
  EXPECT_EQ(graph.edges.size(), 21u);
  const auto edges_at = incidence(graph);
  EXPECT_EQ(edges_at[0].size(), 2u);  // the large one is still there
  EXPECT_EQ(break_loops(graph, 0), 1u);
}

TEST(Resampled, SpacesNodesByTheirRadii) {
  Graph graph = line(41, 2);
  const Graph fine = resampled(graph, 1), coarse = resampled(graph, 4);
  EXPECT_EQ(fine.nodes.size(), 21u);
  EXPECT_EQ(coarse.nodes.size(), 6u);
  for (const auto& [a, b] : fine.edges) EXPECT_NEAR((fine.nodes[a].position - fine.nodes[b].position).norm(), 2, 1e-9);
}

TEST(Resampled, KeepsEndsAndLoops) {
  Graph loop = line(4, 5);
  loop.edges.push_back({3, 0});
  const Graph result = resampled(loop, 3);
  EXPECT_EQ(result.edges.size(), result.nodes.size());
  EXPECT_GE(result.nodes.size(), 3u);
  const Graph short_line = resampled(line(2, 50), 1);
  EXPECT_EQ(short_line.nodes.size(), 2u);
  EXPECT_EQ(short_line.edges.size(), 1u);
}

// Rings of vessels that cross in nodes of four stretches, one beside the other: when one has become two nodes, the way
// from the next one leads over the new node.
TEST(FindLoops, OpensLoopsThroughManyCrossingsSideBySide) {
  constexpr Index kCrossings = 200;
  Graph graph;
  const auto add = [&](double x, double y) {
    graph.nodes.push_back({{x, y, 0}, 8, 8});
    return static_cast<Index>(graph.nodes.size() - 1);
  };
  // Two zigzags from left to right that meet at every crossing, with a node between two crossings on either side.
  Index last = add(0, 0);
  for (Index i = 1; i <= kCrossings; ++i) {
    const Index next = add(20.0 * i, 0);
    for (const double side : {5.0, -5.0}) {
      const Index between = add(20.0 * i - 10, side);
      graph.edges.push_back({last, between});
      graph.edges.push_back({between, next});
    }
    last = next;
  }
  const std::vector<VesselLoop> loops = find_loops(graph, 1, true);
  EXPECT_GE(loops.size(), kCrossings - 2);
  EXPECT_EQ(break_loops(graph, 0), 0u);  // none is left
  for (const auto& [a, b] : graph.edges) EXPECT_TRUE(a < graph.nodes.size() && b < graph.nodes.size());
}

}  // namespace
}  // namespace vmesh::skeleton
