#include "vmesh/evaluation/vessel_distance.h"

#include <cmath>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::icosphere;

TriMesh scaled(TriMesh mesh, double by) {
  for (Vec3& v : mesh.vertices) v *= by;
  return mesh;
}

Centerline ball(double radius) { return Centerline({{Vec3::Zero(), radius}}, {}); }

Centerline random_tree(testing::Draw& draw) {
  std::vector<CenterlineNode> nodes = {{Vec3::Zero(), 1}};
  std::vector<CenterlineSegment> segments;
  for (Index n = 1; n < 12; ++n) {
    const Index parent = draw.below(n);
    nodes.push_back({nodes[parent].position + draw.uniform(0.3, 4) * draw.direction(), draw.uniform(0.2, 1.5)});
    segments.push_back({parent, n});
  }
  return Centerline(nodes, segments);
}

TEST(BoundarySamples, LieOnTheBoundary) {
  testing::Draw draw(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Centerline tree = random_tree(draw);
    const VesselField field(tree);
    const BoundarySamples samples = sample_boundary(field, 500);
    EXPECT_GT(samples.points.size(), 100u);
    for (const BoundarySample& sample : samples.points) {
      const FieldSample found = field.sample_global(sample.position);
      // Not deeper than a billionth of the radius; outside only by the rounding of coordinates of about 10.
      EXPECT_NEAR(found.distance, 0, 1e-9 * sample.radius + 1e-13);
      EXPECT_GE(sample.radius, 0.2);
      EXPECT_LE(sample.radius, 1.5);
    }
  }
}

TEST(BoundarySamples, AreAsManyAsTheirDensitySays) {
  // A cylinder of length 10 and radius 1 with half a sphere at each end.
  const Centerline rod({{{0, 0, 0}, 1}, {{10, 0, 0}, 1}}, {{0, 1}});
  const BoundarySamples samples = sample_boundary(VesselField(rod), 10000);
  const double side = 20 * std::numbers::pi, ends = 4 * std::numbers::pi;
  EXPECT_NEAR(samples.per_mm2, 10000 / side, 1e-9);
  // Half of the samples of two spheres fall: counts of low-discrepancy points are off by a few.
  EXPECT_NEAR(static_cast<double>(samples.points.size()), 10000 * (1 + ends / side), 20);
  // A truncated cone: twice as many samples per length where the vessel is twice as wide.
  const Centerline horn({{{0, 0, 0}, 1}, {{100, 0, 0}, 3}}, {{0, 1}});
  double wide = 0, narrow = 0;
  for (const BoundarySample& sample : sample_boundary(VesselField(horn), 20000).points) {
    if (sample.position.x() < 0 || sample.position.x() > 100) continue;
    (sample.position.x() > 50 ? wide : narrow) += 1;
  }
  EXPECT_NEAR(wide / narrow, 2.5 / 1.5, 0.02);
}

TEST(BoundarySamples, OfABallCoverIt) {
  const Centerline one = ball(2);
  const BoundarySamples samples = sample_boundary(VesselField(one), 1000);
  EXPECT_EQ(samples.points.size(), 1000u);
  Vec3 mean = Vec3::Zero();
  for (const BoundarySample& sample : samples.points) {
    EXPECT_NEAR(sample.position.norm(), 2, 1e-14);
    mean += sample.position / 1000;
  }
  EXPECT_LT(mean.norm(), 0.02);  // random points: 2 / sqrt(1000) = 0.06
}

TEST(VesselDistance, OfASphereAroundABall) {
  const Centerline one = ball(2);
  const VesselField field(one);
  const TriMesh mesh = scaled(icosphere(4), 3);
  const VesselDistance found = measure_vessel_distance(mesh, ClosestPointIndex(mesh), field, 5000);
  // Faces lie up to 1 - cos(h) inside their sphere; h < 0.05 is half the size of a face of 1280.
  const double sagitta = 3 * 0.0025;
  for (const VesselDistanceSide& side : {found.from_mesh, found.from_volume}) {
    EXPECT_EQ(side.mm.count, 5000u);
    EXPECT_NEAR(side.mm.min, 1, sagitta);
    EXPECT_NEAR(side.mm.max, 1, sagitta);
    EXPECT_NEAR(side.relative.median, 0.5, sagitta);
    EXPECT_GT(side.samples_per_mm2, 0);
  }
  EXPECT_NEAR(found.from_mesh.max_at.norm(), 3, sagitta);
  EXPECT_NEAR(found.from_volume.max_at.norm(), 2, 1e-12);
}

TEST(VesselDistance, SeesWhatTheMeshLacks) {
  // The mesh covers one of two balls only: 7 away from the far side of the other, whose radius is 0.5.
  const Centerline two({{{0, 0, 0}, 1}, {{7.5, 0, 0}, 0.5}}, {});
  const VesselField field(two);
  const TriMesh mesh = icosphere(4);
  const VesselDistance found = measure_vessel_distance(mesh, ClosestPointIndex(mesh), field, 20000);
  EXPECT_LT(found.from_mesh.mm.max, 0.01);
  EXPECT_NEAR(found.from_volume.mm.max, 7, 0.02);
  EXPECT_NEAR(found.from_volume.relative.max, 14, 0.04);
  EXPECT_LT((found.from_volume.max_relative_at - Vec3(8, 0, 0)).norm(), 0.1);
}

TEST(VesselDistance, OfVerticesIsSigned) {
  const Centerline one = ball(1);
  const TriMesh mesh{{{0, 0, 3}, {0, 0.5, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  const auto distances = vertex_vessel_distances(mesh, VesselField(one));
  ASSERT_EQ(distances.size(), 3u);
  EXPECT_DOUBLE_EQ(distances[0], 2);
  EXPECT_DOUBLE_EQ(distances[1], -0.5);
  EXPECT_DOUBLE_EQ(distances[2], 0);
}

TEST(VesselDistance, StopsWhenAsked) {
  const Centerline one = ball(1);
  const TriMesh mesh = icosphere(1);
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(measure_vessel_distance(mesh, ClosestPointIndex(mesh), VesselField(one), 100, stop), Cancelled);
}

TEST(VesselDistance, IsTheSameOnAnyNumberOfThreads) {
  testing::Draw draw(5);
  const Centerline tree = random_tree(draw);
  const VesselField field(tree);
  const TriMesh mesh = scaled(icosphere(4), 3);
  const ClosestPointIndex index(mesh);
  const auto on_threads = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return measure_vessel_distance(mesh, index, field, 30'000); });
  };
  const VesselDistance one = on_threads(1), many = on_threads(5);
  for (const auto side : {&VesselDistance::from_mesh, &VesselDistance::from_volume}) {
    EXPECT_EQ((one.*side).mm.mean, (many.*side).mm.mean);
    EXPECT_EQ((one.*side).mm.count, (many.*side).mm.count);
    EXPECT_EQ((one.*side).relative.p95, (many.*side).relative.p95);
    EXPECT_EQ((one.*side).max_at, (many.*side).max_at);
  }
  EXPECT_EQ(vertex_vessel_distances(mesh, field).size(), mesh.vertices.size());
}

}  // namespace
}  // namespace vmesh
