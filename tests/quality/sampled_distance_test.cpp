#include "vmesh/quality/sampled_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/quality/hausdorff.h"

#include "soups.h"

namespace vmesh {
namespace {

using testing::cube, testing::moved, testing::icosphere;

TEST(SurfaceSamples, AreSpreadByArea) {
  // Two triangles of areas 8 and 2.
  const TriMesh mesh = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 1, 3}, {1, 1, 2}}};
  for (const std::size_t count : {1, 10, 1000, 12345}) {
    const auto samples = sample_surface(mesh, count);
    ASSERT_EQ(samples.size(), count);
    std::vector<double> on_face(3, 0);
    for (const SurfaceSample& sample : samples) {
      ++on_face[sample.face];
      const Vec3& p = sample.position;
      EXPECT_GE(p.minCoeff(), 0);
      EXPECT_TRUE(sample.face == 0 ? p.z() == 0 && p.x() + p.y() <= 4 + 1e-14
                                   : p.y() == 0 && p.x() / 4 + p.z() <= 1 + 1e-14);
    }
    EXPECT_NEAR(on_face[0], 0.8 * static_cast<double>(count), 1);
    EXPECT_EQ(on_face[2], 0);
  }
}

TEST(SurfaceSamples, AverageToWhatIntegralsAre) {
  const auto samples = sample_surface({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 10000);
  double x = 0, xx = 0, xy = 0;
  for (const SurfaceSample& s : samples) {
    x += s.position.x() / 10000;
    xx += s.position.x() * s.position.x() / 10000;
    xy += s.position.x() * s.position.y() / 10000;
  }
  // The means over the triangle. Low-discrepancy points are off by log(n)^2 / n or so; random ones by 1 / sqrt(n).
  EXPECT_NEAR(x, 1.0 / 3, 2e-3);
  EXPECT_NEAR(xx, 1.0 / 6, 2e-3);
  EXPECT_NEAR(xy, 1.0 / 12, 2e-3);
}

TEST(SampledDistance, OfParallelSquaresIsTheirDistance) {
  const TriMesh square = {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const SampledDistance found = sample_distance(square, ClosestPointIndex(moved(square, {0, 0, 0.5})), 400);
  EXPECT_EQ(found.distance.count, 400u);
  EXPECT_DOUBLE_EQ(found.samples_per_mm2, 100);
  for (const double v : {found.distance.min, found.distance.median, found.distance.p99, found.distance.max}) {
    EXPECT_DOUBLE_EQ(v, 0.5);
  }
  EXPECT_NEAR(found.distance.mean, 0.5, 1e-14);
}

TEST(SampledDistance, IsNoLargerThanTheHausdorffDistance) {
  testing::Draw draw(7);
  const TriMesh a = testing::shaken(icosphere(3), draw, 0.05), b = icosphere(2);
  const SampledDistance found = sample_distance(a, ClosestPointIndex(b), 20000);
  const OneSidedHausdorff exact = one_sided_hausdorff(a, b);
  EXPECT_LE(found.distance.max, exact.upper);
  EXPECT_GE(found.distance.max, 0.8 * exact.lower);  // 16 samples a face
  EXPECT_LT(found.distance.mean, found.distance.rms);
  EXPECT_LT(found.distance.rms, found.distance.max);
}

TEST(SampledDistance, OfWhatHasNoAreaHasNoSamples) {
  const ClosestPointIndex index(cube());
  const SampledDistance found = sample_distance({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}}, index, 100);
  EXPECT_EQ(found.distance.count, 0u);
  EXPECT_EQ(found.samples_per_mm2, 0);
  EXPECT_TRUE(sample_surface({}, 100).empty());
  EXPECT_TRUE(sample_surface(cube(), 0).empty());
}

TEST(SampledDistance, RefusesBadInput) {
  TriMesh bad = cube();
  bad.vertices[2].x() = NAN;
  EXPECT_THROW(sample_surface(bad, 10), InvalidInput);
  bad = cube();
  bad.faces[0][0] = 99;
  EXPECT_THROW(sample_surface(bad, 10), InvalidInput);
}

TEST(SampledDistance, StopsWhenAsked) {
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(sample_distance(cube(), ClosestPointIndex(cube()), 10, stop), Cancelled);
}

TEST(VertexDistances, AreOnePerVertex) {
  TriMesh mesh = moved(cube(), {3, 0, 0});
  mesh.vertices.emplace_back(NAN, 0, 0);
  const auto distances = vertex_distances(mesh, ClosestPointIndex(cube()));
  ASSERT_EQ(distances.size(), 9u);
  for (Index v = 0; v < 8; ++v) EXPECT_DOUBLE_EQ(distances[v], v & 1u ? 3 : 2);
  EXPECT_TRUE(std::isnan(distances[8]));
}

}  // namespace
}  // namespace vmesh
