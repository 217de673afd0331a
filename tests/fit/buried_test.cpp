#include "fit/buried.h"

#include <gtest/gtest.h>

#include "vmesh/fit/fit_surface.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

using fitting::span_polygon;

double area_of(const std::vector<Triangle>& triangles, const std::vector<Vec3>& corners) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) area += (corners[b] - corners[a]).cross(corners[c] - corners[a]).norm() / 2;
  return area;
}

const auto kAll = [](Index, Index) { return true; };

TEST(SpanPolygon, CoversWhatIsFlat) {
  // An L, which a fan from its first corner would not cover.
  const std::vector<Vec3> corners = {{0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}};
  const std::vector<Triangle> triangles = span_polygon(corners, kAll);
  ASSERT_EQ(triangles.size(), 4u);
  EXPECT_NEAR(area_of(triangles, corners), 3, 1e-12);
  for (const auto& [a, b, c] : triangles)
    EXPECT_GE((corners[b] - corners[a]).cross(corners[c] - corners[a]).z(), 0);  // oriented as the polygon is
}

TEST(SpanPolygon, TakesTheSmallerDiagonal) {
  // A quadrilateral bent along either diagonal.
  const std::vector<Vec3> corners = {{-1, 0, 1}, {0, -3, 0}, {1, 0, 1}, {0, 3, 0}};
  const std::vector<Triangle> triangles = span_polygon(corners, kAll);
  ASSERT_EQ(triangles.size(), 2u);
  const auto other = [](Index i, Index j) { return !(i == 0 && j == 2) && !(i == 2 && j == 0); };
  const std::vector<Triangle> forced = span_polygon(corners, other);
  ASSERT_EQ(forced.size(), 2u);
  EXPECT_LT(area_of(triangles, corners), area_of(forced, corners));
}

TEST(SpanPolygon, SaysWhereThereIsNone) {
  EXPECT_TRUE(span_polygon({{0, 0, 0}, {1, 0, 0}}, kAll).empty());
  const auto none = [](Index, Index) { return false; };
  EXPECT_TRUE(span_polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, none).empty());
}

/// A trunk and two daughters that part slowly.
Centerline narrow_fork(double radius, double spread) {
  std::vector<CenterlineNode> nodes = {{{0, 0, -10}, radius}, {{0, 0, -5}, radius}, {{0, 0, 0}, radius}};
  std::vector<CenterlineSegment> segments = {{0, 1}, {1, 2}};
  for (const double side : {-1.0, 1.0}) {
    Index from = 2;
    for (int i = 1; i <= 10; ++i) {
      nodes.push_back({{side * spread * i, 0, 2.5 * i}, radius});
      const auto to = static_cast<Index>(nodes.size() - 1);
      segments.push_back({from, to});
      from = to;
    }
  }
  return {nodes, segments};
}

struct Fits {
  FitReport best, report;  // from as wide a fork, from a thinner one
};

// To a fork 3 mm wide, from one that is thinner: its daughters part below where the reference's do.
Fits fits_of_fork(double spread, double radius, int around) {
  const Centerline wide = narrow_fork(3, spread), thin = narrow_fork(radius, spread);
  GenerateOptions options;
  options.threads = 1;
  options.around = 24;
  const TriMesh reference = generate_surface(wide, options).mesh;
  FitOptions fit;
  fit.threads = 1;
  options.around = around;
  const auto fitted = [&](const Centerline& centerline) {
    GenerateResult result = generate_surface(centerline, options);
    const FitReport report = fit_surface(result, centerline, reference, fit);
    EXPECT_TRUE(result.is_sound());
    return report;
  };
  return {fitted(wide), fitted(thin)};
}

// Measured 2.6 to 3 where walls stay in the crevice; without, .4 to 1.3, at the narrow new crotch.
constexpr double kWithoutWalls = 1.5;

TEST(BuriedWalls, GiveWayWhereTheReferenceIsOneLumen) {
  // Half as wide, the daughters part 12 mm below.
  for (const int around : {6, 8, 12}) {
    const auto [best, report] = fits_of_fork(0.5, 1.5, around);
    for (const UnmatchedPart& part : report.unsupported) EXPECT_FALSE(part.inside) << around;
    EXPECT_LT(report.after.hausdorff.upper(), kWithoutWalls) << around;
    EXPECT_LT(report.after.mean(), 1.1 * best.after.mean()) << around;
  }
}

TEST(BuriedWalls, GiveWayInOtherForks) {
  struct Case {
    double spread, radius;
    int around;
  };
  for (const auto& [spread, radius, around] : {Case{0.5, 1.65, 8}, Case{0.6, 1.65, 12}, Case{0.7, 1.95, 8}}) {
    const auto [best, report] = fits_of_fork(spread, radius, around);
    for (const UnmatchedPart& part : report.unsupported) EXPECT_FALSE(part.inside) << spread;
    EXPECT_LT(report.after.hausdorff.upper(), kWithoutWalls) << spread;
    EXPECT_LT(report.after.mean(), 1.1 * best.after.mean()) << spread;
  }
}

}  // namespace
}  // namespace vmesh
