#include "skeleton/shared_lumen.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vmesh::skeleton {
namespace {

constexpr Index kLeg = 8;  // nodes of one leg

/// Two legs along z, `apart` from each other at z = 0 and, if they part, farther apart above, joined at the top. The
/// radius is 1 mm everywhere.
Graph hairpin(double apart, double more_above = 0) {
  Graph graph;
  for (Index n = 0; n < 2 * kLeg; ++n) {
    const double side = n < kLeg ? -1 : 1, z = n < kLeg ? n : 2 * kLeg - 1 - n;
    graph.nodes.push_back(
        {Vec3(side * (apart / 2 + more_above * std::sin(std::numbers::pi * z / (kLeg - 1))), 0, z), 1});
    if (n > 0) graph.edges.push_back({n - 1, n});
  }
  return graph;
}

/// The wall of a straight tube along z around (x, 0), as points 0.2 mm apart.
void add_tube(SurfaceSamples& samples, double x, double radius) {
  constexpr double kStep = 0.2;
  const auto around = static_cast<int>(2 * std::numbers::pi * radius / kStep);
  for (double z = -radius; z < kLeg + radius; z += kStep) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      samples.points.emplace_back(x + radius * std::cos(angle), radius * std::sin(angle), z);
      samples.areas.push_back(kStep * kStep);
    }
  }
}

TEST(SharedLumen, TheLegsOfAHairpinInAWideVesselBecomeOne) {
  Graph graph = hairpin(2.1);
  SurfaceSamples samples;
  add_tube(samples, 0, 2.2);
  EXPECT_EQ(merge_in_one_lumen(graph, samples), kLeg);
  compact(graph);
  ASSERT_EQ(graph.nodes.size(), kLeg);
  EXPECT_EQ(graph.edges.size(), kLeg - 1);  // a line, not a ladder
  for (const Node& node : graph.nodes) EXPECT_NEAR(node.position.x(), 0, 1e-12);
  EXPECT_EQ(merge_in_one_lumen(graph, samples), 0u);
}

TEST(SharedLumen, VesselsWithAWallBetweenThemStayTwo) {
  Graph graph = hairpin(2.1);
  SurfaceSamples samples;
  for (const double x : {-1.05, 1.05}) add_tube(samples, x, 1);
  EXPECT_EQ(merge_in_one_lumen(graph, samples), 0u);
  EXPECT_EQ(graph.nodes.size(), 2 * kLeg);
}

TEST(SharedLumen, LegsThatGoAroundSomethingStayTwo) {
  Graph graph = hairpin(2.1, 3);
  const SurfaceSamples samples;  // no wall anywhere
  EXPECT_EQ(merge_in_one_lumen(graph, samples), 0u);
}

TEST(SharedLumen, WhatWasMergedIsFittedAndNothingElseMoves) {
  Graph graph = hairpin(2.1);
  for (Index n = 1; n <= 5; ++n) {  // a vessel that goes on from one leg
    graph.nodes.push_back({Vec3(-1.05, 0, -static_cast<double>(n)), 1});
    graph.edges.push_back({n == 1 ? 0 : 2 * kLeg + n - 2, 2 * kLeg + n - 1});
  }
  SurfaceSamples samples;
  add_tube(samples, 0, 2.2);
  ASSERT_EQ(merge_in_one_lumen(graph, samples), kLeg);
  compact(graph);
  const Graph before = graph;
  fit_merged_cones(graph, samples, 20);
  ASSERT_EQ(graph.nodes.size(), kLeg + 5);
  for (Index n = 0; n < kLeg; ++n) EXPECT_GT(graph.nodes[n].radius, 1.5) << n;  // the lumen's is 2.2
  for (Index n = kLeg + 2; n < kLeg + 5; ++n) {
    EXPECT_EQ(graph.nodes[n].position, before.nodes[n].position);
    EXPECT_EQ(graph.nodes[n].radius, before.nodes[n].radius);
  }
}

}  // namespace
}  // namespace vmesh::skeleton
