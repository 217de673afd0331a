// Arc length, rings and the graph that they steer growth with.
#include "surface/tubes/growth_skeleton.h"

#include <gtest/gtest.h>

#include "centerlines.h"
#include "surface/input/buried_branches.h"

namespace vmesh {
namespace {

struct Steered {
  explicit Steered(Centerline c, int around = 6)
      : centerline(std::move(c)), field(centerline, 0.5), tubes(field, {around}) {
    skeleton = make_growth_skeleton(tubes, whole_plan(tubes));
  }

  Centerline centerline;
  VesselField field;
  VesselRings tubes;
  const std::vector<BranchAxis>& axes = tubes.axes();
  GrowthSkeleton skeleton;
};

Centerline cone() { return {{{{0, 0, 0}, 1}, {{4, 0, 0}, 2}, {{4, 8, 0}, 1}}, {{1, 0}, {1, 2}}}; }

TEST(BranchAxis, MeasuresArcLengthAcrossSegmentsThatRunEitherWay) {
  const Centerline centerline = cone();
  const auto branches = find_branches(centerline);
  const BranchAxis axis(centerline, branches[0]);
  EXPECT_EQ(axis.length(), 12);
  EXPECT_TRUE(axis.starts_at_tip() && axis.ends_at_tip() && !axis.periodic());
  EXPECT_EQ(axis.at(1).position, Vec3(1, 0, 0));
  EXPECT_DOUBLE_EQ(axis.at(1).radius, 1.25);
  EXPECT_EQ(axis.at(1).t, 0.75);  // of segment 0, which runs back
  EXPECT_EQ(axis.at(6).position, Vec3(4, 2, 0));
  EXPECT_EQ(axis.at(99).position, Vec3(4, 8, 0));
  EXPECT_EQ(axis.place_of(0, 0.75), 1);
  EXPECT_EQ(axis.apart(2, 9), 7);
}

TEST(BranchAxis, IntegratesLengthOverRadius) {
  const Centerline centerline = cone();
  const auto branches = find_branches(centerline);
  const BranchAxis axis(centerline, branches[0]);
  // Along a cone: length / (r1 - r0) * ln(r1 / r0).
  EXPECT_NEAR(axis.length_in_radii(), 4 * std::log(2.0) + 8 * std::log(2.0), 1e-12);
  for (const double place : {0.0, 0.7, 3.9, 4.0, 7.5, 12.0}) {
    double radii = 0;
    const int steps = 20000;  // midpoint rule: error about (length / steps)^2
    for (int i = 0; i < steps; ++i) radii += place / steps / axis.at(place * (i + 0.5) / steps).radius;
    EXPECT_NEAR(axis.place_at_radii(radii), place, 1e-6);
  }
}

TEST(BranchAxis, GoesRoundARing) {
  const Centerline centerline = testing::ring(24);
  const auto branches = find_branches(centerline);
  const BranchAxis axis(centerline, branches[0]);
  EXPECT_TRUE(axis.periodic());
  EXPECT_NEAR((axis.at(axis.length() + 3).position - axis.at(3).position).norm(), 0, 1e-12);
  EXPECT_NEAR(axis.apart(1, axis.length() - 1), 2, 1e-12);
}

TEST(GrowthSkeleton, OfATubeHasRingsOnTheWallEvenlyInRadii) {
  const Steered tube(testing::straight_tube());
  ASSERT_EQ(tube.skeleton.tubes.size(), 1u);
  EXPECT_TRUE(tube.skeleton.junctions.empty());
  const Tube& t = tube.skeleton.tubes[0];
  EXPECT_TRUE(t.starts_at_tip && t.ends_at_tip);
  EXPECT_EQ(t.rings.front().place, 0);
  EXPECT_EQ(t.rings.back().place, 8);
  for (const Ring& ring : t.rings) {
    ASSERT_EQ(ring.points.size(), 6u);
    for (const auto& p : ring.points) {
      EXPECT_NEAR(tube.field.sample_global(p.position).distance, 0, 2e-3);  // 1e-3 radii
      EXPECT_NEAR((p.position - ring.center).dot(ring.normal), 0, 1e-12);
    }
  }
  EXPECT_EQ(tube.skeleton.component_count(), 1u);
  EXPECT_EQ(tube.skeleton.cycle_rank(), 0u);
}

TEST(GrowthSkeleton, OfAForkIsAJunctionWithThreeTubes) {
  const Steered fork(testing::fork());
  EXPECT_EQ(fork.skeleton.tubes.size(), 3u);
  ASSERT_EQ(fork.skeleton.junctions.size(), 1u);
  EXPECT_EQ(fork.skeleton.junctions[0].nodes, (std::vector<Index>{1}));
  EXPECT_EQ(docks_of(fork.skeleton.junctions[0]).size(), 3u);
}

TEST(GrowthSkeleton, CountsComponentsAndCycles) {
  EXPECT_EQ(Steered(testing::ring(24)).skeleton.cycle_rank(), 1u);
  EXPECT_EQ(Steered(testing::two_forks()).skeleton.component_count(), 2u);
  // Two junctions joined by two tubes.
  const Steered loop(
      {{{{-6, 0, 0}, 1}, {{0, 0, 0}, 1}, {{6, 5, 0}, 1}, {{6, -5, 0}, 1}, {{12, 0, 0}, 1}, {{18, 0, 0}, 1}},
       {{0, 1}, {1, 2}, {2, 4}, {1, 3}, {3, 4}, {4, 5}}});
  EXPECT_GE(loop.skeleton.junctions.size(), 2u);  // sharp bends are junctions as well
  EXPECT_EQ(loop.skeleton.cycle_rank(), 1u);
  EXPECT_EQ(loop.skeleton.component_count(), 1u);
}

TEST(GrowthSkeleton, JoinsSiblingsUntilTheyPart) {
  // At 10 degrees the axes are 1.35 + 1 radii apart after about 13: no ring before that.
  const Steered siblings(testing::fork(10));
  for (const Tube& tube : siblings.skeleton.tubes) {
    if (tube.branch == 0) continue;  // the trunk
    for (const Ring& ring : tube.rings) EXPECT_GT(ring.center.norm(), 9);
  }
}

TEST(BuriedBranches, AreThoseThatOneConeCoversPieceByPiece) {
  const std::vector<CenterlineNode> trunk = {{{0, 0, 0}, 2}, {{10, 0, 0}, 2}, {{-10, 0, 0}, 2}};
  const auto buried_at = [&](const Vec3& tip, double radius) {
    auto nodes = trunk;
    nodes.push_back({tip, radius});
    const Centerline centerline(nodes, {{0, 1}, {0, 2}, {0, 3}});
    const VesselField field(centerline);
    return without_buried_branches(field).buried.size();
  };
  EXPECT_EQ(buried_at({4, 1.4, 0}, 0.5), 1u);
  EXPECT_EQ(buried_at({4, 1.54, 0}, 0.5), 1u);  // stands out by 0.08 of its radius
  EXPECT_EQ(buried_at({4, 1.6, 0}, 0.5), 0u);   // by 0.2
  EXPECT_EQ(buried_at({4, 6, 0}, 0.5), 0u);
}

TEST(BuriedBranches, OfTwoThatCoincideOneStays) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{-5, 0, 0}, 1}, {{6, 0, 0}, 0.8}, {{6, 0.01, 0}, 0.8}},
                              {{0, 1}, {0, 2}, {0, 3}});
  const VesselField field(centerline);
  const GrowthCenterline left = without_buried_branches(field);
  EXPECT_EQ(left.buried.size(), 1u);
  EXPECT_EQ(left.centerline.segments().size(), 2u);
  for (Index s = 0; s < left.segment.size(); ++s) {
    const auto& [a, b] = centerline.segment(left.segment[s]);
    EXPECT_EQ(left.node[left.centerline.segment(s).a], a);
    EXPECT_EQ(left.node[left.centerline.segment(s).b], b);
  }
}

TEST(BuriedBranches, DenselySampledEndsStay) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i <= 400; ++i) {
    nodes.push_back({{0.02 * i, 0, 0}, 1});
    if (i > 0) segments.push_back({i - 1, i});
  }
  const Centerline centerline(nodes, segments);
  const VesselField field(centerline);
  EXPECT_TRUE(without_buried_branches(field).buried.empty());
}

}  // namespace
}  // namespace vmesh
