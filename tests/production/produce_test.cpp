#include "vmesh/production/produce.h"

#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// A trunk with more nodes than its surface needs, and two branches.
Centerline fork() {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index n = 0; n <= 40; ++n) {
    nodes.push_back({Vec3(0, 0, n), 2});
    if (n > 0) segments.push_back({n - 1, n});
  }
  nodes.push_back({Vec3(12, 0, 55), 1.5});
  nodes.push_back({Vec3(-12, 0, 55), 1.4});
  segments.push_back({40, 41});
  segments.push_back({40, 42});
  return {nodes, segments};
}

/// Two vessels, not joined, less than their radii apart.
Centerline crossing() {
  return {{{{-20, 0, 0}, 2}, {{20, 0, 0}, 2}, {{0, -20, 3}, 2}, {{0, 20, 3}, 2}}, {{0, 1}, {2, 3}}};
}

TEST(Produce, RefersToTheOriginal) {
  const Centerline centerline = fork();
  const Production production = produce(centerline, {});
  EXPECT_TRUE(production.result.is_sound());
  ASSERT_TRUE(production.prepared.simplified);
  EXPECT_LT(production.prepared.grown().nodes().size(), centerline.nodes().size());
  EXPECT_GT(production.result.simplification.nodes_left_out, 20u);
  Index last = 0;
  for (const auto& [segment, t] : production.result.binding) {
    ASSERT_LT(segment, centerline.segments().size());
    last = std::max(last, segment);
  }
  EXPECT_EQ(last, 41u);
  EXPECT_TRUE(production.ends.ends.empty());
}

TEST(Produce, SeparatesVesselsUnlessTheyAreToBeKept) {
  const Centerline centerline = crossing();
  const Production apart = produce(centerline, {});
  EXPECT_TRUE(apart.result.is_sound());
  ASSERT_TRUE(apart.prepared.separated);
  EXPECT_EQ(apart.prepared.contacts().size(), 1u);
  ProductionOptions options;
  options.preparation.separate = false;
  const Production kept = produce(centerline, {}, options);
  EXPECT_FALSE(kept.result.is_sound());
  EXPECT_FALSE(kept.prepared.separated);
  EXPECT_EQ(kept.prepared.contacts().size(), 1u);
}

// The rings of a stub as long as its radius, scaled to the area of a circle, reach into the vessel beside it.
TEST(Produce, FlatEndsOfAStubBesideAVesselDoNotCrossIt) {
  const Centerline centerline = {{{{0, 0, 0}, 1}, {{0, 0, 1}, 1}, {{2.2676, .139, 1}, 1.2}, {{2.27, 3.139, 2}, 1.2}},
                                 {{0, 1}, {2, 3}}};
  ProductionOptions options;
  options.ends = EndShape::flat;
  const Production production = produce(centerline, {}, options);
  EXPECT_TRUE(production.result.is_sound());
  EXPECT_EQ(production.ends.ends.size(), 4u);
  EXPECT_EQ(production.ends.narrowed, (std::vector<Index>{0, 1, 2}));  // not the end that is away from the stub
  EXPECT_EQ(problems_of(production.ends).size(), 3u);
  EXPECT_NEAR(production.ends.ends[3].area, std::numbers::pi * 1.2 * 1.2, 1e-9);
}

/// A vessel along x that ends in front of the middle of another, `gap` away from its wall.
Centerline crossroads(double gap) {
  return {{{{-10, 0, 0}, 1}, {{0, 0, 0}, 1}, {{gap + 2, -12, 0}, 2}, {{gap + 2, 12, 0}, 2}}, {{0, 1}, {2, 3}}};
}

TEST(Produce, AnExtensionThatRunsIntoAVesselIsNamedWithTheLongestThatFits) {
  ProductionOptions options;
  options.ends = EndShape::flat;
  options.extension = 5;
  const Production production = produce(crossroads(4), {}, options);
  EXPECT_FALSE(production.result.is_sound());
  ASSERT_EQ(production.ends.blocked.size(), 1u);
  const BlockedExtension& blocked = production.ends.blocked[0];
  EXPECT_EQ(blocked.node, 1u);
  EXPECT_EQ(blocked.branch, 1u);
  EXPECT_EQ(blocked.length, 5);
  // The wall is four radii ahead, by the error of hexagons; a quarter is left free, in radii of the corners.
  EXPECT_NEAR(blocked.longest, 3.7, 0.25);
  EXPECT_NEAR(blocked.at.x(), 4, 0.35);
  const std::vector<std::string> problems = problems_of(production.ends);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("the flow extension at node 1, 5 radii long, runs into the vessel of branch 1 at ("),
            std::string::npos)
      << problems[0];
  options.extension = blocked.longest;
  EXPECT_TRUE(produce(crossroads(4), {}, options).result.is_sound());
}

TEST(Produce, FittedExtensionsAreAsLongAsThereIsRoom) {
  ProductionOptions options;
  options.ends = EndShape::flat;
  options.extension = kLongestFittedExtension;
  options.fit_extensions = true;
  for (const double gap : {2.0, 4.0, 8.0, 20.0}) {
    SCOPED_TRACE(gap);
    const Production production = produce(crossroads(gap), {}, options);
    EXPECT_TRUE(production.result.is_sound());
    EXPECT_TRUE(production.ends.blocked.empty());
    ASSERT_EQ(production.ends.ends.size(), 4u);
    const FlatEnd& end = production.ends.ends[1];
    if (gap > kLongestFittedExtension + 1) {
      EXPECT_EQ(end.extension, kLongestFittedExtension);
    } else {
      EXPECT_LT(end.extension, gap);
      EXPECT_GT(end.extension, gap - 0.6);
    }
    // A circle of the area of the end is as wide as the vessel.
    EXPECT_NEAR(end.center.x(), end.extension, 0.01);
    for (const Index free : {0u, 2u, 3u}) EXPECT_EQ(production.ends.ends[free].extension, kLongestFittedExtension);
  }
}

TEST(Produce, FittedExtensionsLeaveRoomForEachOther) {
  const Centerline facing = {{{{-10, 0, 0}, 1}, {{0, 0, 0}, 1}, {{6, .5, 0}, 1}, {{16, .5, 0}, 1}}, {{0, 1}, {2, 3}}};
  ProductionOptions options;
  options.ends = EndShape::open;
  options.extension = kLongestFittedExtension;
  options.fit_extensions = true;
  const Production production = produce(facing, {}, options);
  EXPECT_TRUE(production.result.is_sound());
  ASSERT_EQ(production.ends.ends.size(), 4u);
  EXPECT_NEAR(production.ends.ends[1].extension, 5.7, 0.1);  // the first takes what there is
  EXPECT_EQ(production.ends.ends[2].extension, 0);
  ASSERT_EQ(production.ends.blocked.size(), 1u);
  EXPECT_EQ(production.ends.blocked[0].branch, 0u);
  EXPECT_NE(problems_of(production.ends).at(0).find("the end at node 2 has no flow extension: the vessel of branch 0"),
            std::string::npos)
      << problems_of(production.ends).at(0);
}

TEST(Produce, EndsAsWanted) {
  const Centerline centerline = fork();
  ProductionOptions options;
  options.ends = EndShape::flat;
  options.growth.open_ends.nodes = {41};
  const Production production = produce(centerline, {}, options);
  ASSERT_EQ(production.ends.ends.size(), 3u);
  for (const FlatEnd& end : production.ends.ends) EXPECT_EQ(end.capped, end.node != 41u);
  ASSERT_EQ(production.result.openings.size(), 1u);
  EXPECT_EQ(production.result.openings[0].node, 41u);
  options.growth.open_ends = {true, {}};
  EXPECT_EQ(produce(centerline, {}, options).result.openings.size(), 3u);
  options.growth.open_ends = {false, {20}};
  EXPECT_THROW(produce(centerline, {}, options), InvalidInput);
  options = {};
  options.extension = 2;
  EXPECT_THROW(produce(centerline, {}, options), InvalidInput);
}

TEST(Produce, GrowsOnceMoreAroundAllNodesIfTheFirstSurfaceIsNotSound) {
  const Centerline centerline = fork();
  std::vector<std::size_t> nodes;
  std::size_t prepared = 0, refined = 0;
  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline&) { ++prepared; };
  steps.grow = [&](const Centerline& around, const GenerateOptions& options) {
    nodes.push_back(around.nodes().size());
    GenerateResult result = generate_surface(around, options);
    if (nodes.size() == 1) result.defects.emplace_back();
    return result;
  };
  steps.refine = [&](GenerateResult&, const PreparedCenterline&) {
    ++refined;
    return false;
  };
  const Production production = produce(centerline, {}, {}, {}, steps);
  EXPECT_TRUE(production.result.is_sound());
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_LT(nodes[0], nodes[1]);
  EXPECT_GE(nodes[1], centerline.nodes().size());
  EXPECT_EQ(prepared, 2u);
  EXPECT_EQ(refined, 1u);  // only what is kept
}

TEST(Produce, KnowsShapesOfEndsByTheirNames) {
  for (const EndShape shape : {EndShape::round, EndShape::flat, EndShape::open})
    EXPECT_EQ(parse_end_shape(to_string(shape)), shape);
  EXPECT_THROW(parse_end_shape("pointed"), InvalidInput);
}

}  // namespace
}  // namespace vmesh
