#include "vmesh/mesh/triangle_quality.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

// An angle is one atan2 of a cross and a dot product: a few rounding errors of at most pi each, divided by pi / 3.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

Vec3 at_angle(double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians), 0};
}

TEST(EquiangleSkewness, OfKnownTriangles) {
  const Vec3 o(0, 0, 0), x(1, 0, 0);
  EXPECT_NEAR(equiangle_skewness(o, x, at_angle(60)), 0, kRounding);
  EXPECT_NEAR(equiangle_skewness(o, x, Vec3(0, 1, 0)), 0.25, kRounding);            // 90 45 45
  EXPECT_NEAR(equiangle_skewness(o, x, Vec3(0, std::sqrt(3), 0)), 0.5, kRounding);  // 90 60 30
  EXPECT_NEAR(equiangle_skewness(o, x, at_angle(120)), 0.5, kRounding);             // 120 30 30
  EXPECT_NEAR(equiangle_skewness(o, x, at_angle(20)), 2.0 / 3, kRounding);          // 20 80 80: the least counts
  EXPECT_NEAR(equiangle_skewness(o, x, at_angle(150)), 0.75, kRounding);            // 150 15 15
}

TEST(EquiangleSkewness, IsOneForADegenerateTriangle) {
  const Vec3 o(0, 0, 0), x(1, 0, 0);
  EXPECT_EQ(equiangle_skewness(o, x, Vec3(2, 0, 0)), 1);
  EXPECT_EQ(equiangle_skewness(x, o, Vec3(2, 0, 0)), 1);
  EXPECT_EQ(equiangle_skewness(o, o, x), 1);
  EXPECT_EQ(equiangle_skewness(o, x, o), 1);
  EXPECT_EQ(equiangle_skewness(x, o, o), 1);
  EXPECT_EQ(equiangle_skewness(x, x, x), 1);
}

TEST(EquiangleSkewness, StaysBetweenZeroAndOneAndCaresForNeitherOrderNorSize) {
  testing::Draw draw(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = draw.in_cube(1), b = draw.in_cube(1),
               c = draw.chance(0.3) ? Vec3(a + 1e-9 * draw.in_cube(1)) : draw.in_cube(1);
    const double skewness = equiangle_skewness(a, b, c);
    EXPECT_GE(skewness, 0);
    EXPECT_LE(skewness, 1);
    EXPECT_NEAR(equiangle_skewness(b, c, a), skewness, kRounding);
    EXPECT_NEAR(equiangle_skewness(b, a, c), skewness, kRounding);
    // A power of two costs no digit, so nothing may change at all.
    for (const double scale : {0x1p-100, 0x1p+100}) {
      EXPECT_EQ(equiangle_skewness(scale * a, scale * b, scale * c), skewness);
    }
  }
}

TEST(EquiangleSkewness, OfAMeshIsThatOfItsFacesInOrder) {
  TriMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, at_angle(60)};
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {0, 1, 1}};
  const auto skewness = equiangle_skewness(mesh);
  ASSERT_EQ(skewness.size(), 3u);
  EXPECT_NEAR(skewness[0], 0.25, kRounding);
  EXPECT_NEAR(skewness[1], 0, kRounding);
  EXPECT_EQ(skewness[2], 1);
  const auto summary = summarize_skewness(mesh);
  EXPECT_NEAR(summary.mean, 1.25 / 3, kRounding);
  EXPECT_EQ(summary.max, 1);
}

TEST(TriangleMeasures, OfKnownTriangles) {
  const Vec3 o(0, 0, 0), x(1, 0, 0);
  // Lengths, areas and ratios take a dozen roundings; angles in degrees are up to 180.
  const double rounding = kRounding, degrees = 180 * kRounding;
  TriangleMeasures m = measure_triangle(o, x, at_angle(60));
  EXPECT_NEAR(m.area_mm2, std::sqrt(3) / 4, rounding);
  EXPECT_NEAR(m.min_angle_deg, 60, degrees);
  EXPECT_NEAR(m.max_angle_deg, 60, degrees);
  EXPECT_NEAR(m.equiangle_skewness, 0, rounding);
  EXPECT_NEAR(m.shortest_to_longest_edge, 1, rounding);
  EXPECT_NEAR(m.double_inradius_to_circumradius, 1, rounding);
  EXPECT_NEAR(m.scaled_inradius_to_longest_edge, 1, rounding);

  m = measure_triangle({0, 4, 0}, o, {3, 0, 0});  // 3 4 5: r = 1, R = 2.5
  EXPECT_NEAR(m.area_mm2, 6, 6 * rounding);
  EXPECT_NEAR(m.min_angle_deg, std::atan2(3, 4) * 180 / std::numbers::pi, degrees);
  EXPECT_NEAR(m.max_angle_deg, 90, degrees);
  EXPECT_NEAR(m.shortest_to_longest_edge, 0.6, rounding);
  EXPECT_NEAR(m.double_inradius_to_circumradius, 0.8, rounding);
  EXPECT_NEAR(m.scaled_inradius_to_longest_edge, 2 * std::sqrt(3) / 5, rounding);

  m = measure_triangle(o, x, at_angle(150));
  EXPECT_NEAR(m.min_angle_deg, 15, degrees);
  EXPECT_NEAR(m.max_angle_deg, 150, degrees);
}

TEST(TriangleMeasures, OfDegenerateTrianglesAreTheWorstThereIs) {
  const Vec3 o(0, 0, 0), x(1, 0, 0);
  for (const auto& [a, b, c] : {std::array{o, x, Vec3(3, 0, 0)}, std::array{o, o, x}, std::array{x, x, x}}) {
    const TriangleMeasures m = measure_triangle(a, b, c);
    EXPECT_EQ(m.area_mm2, 0);
    EXPECT_EQ(m.min_angle_deg, 0);
    EXPECT_EQ(m.max_angle_deg, 180);
    EXPECT_EQ(m.equiangle_skewness, 1);
    EXPECT_EQ(m.double_inradius_to_circumradius, 0);
    EXPECT_EQ(m.scaled_inradius_to_longest_edge, 0);
  }
}

TEST(TriangleMeasures, AgreeWithTheDefinitionsOnRandomTriangles) {
  testing::Draw draw(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = draw.in_cube(1), b = draw.in_cube(1), c = draw.in_cube(1);
    const auto angle = [](const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); };
    const double angles[3] = {angle(b - a, c - a), angle(a - b, c - b), angle(a - c, b - c)};
    const auto [least, most] = std::minmax({angles[0], angles[1], angles[2]});
    const double third = std::numbers::pi / 3, lengths[3] = {(c - b).norm(), (a - c).norm(), (b - a).norm()};
    const double area = (b - a).cross(c - a).norm() / 2, perimeter = lengths[0] + lengths[1] + lengths[2];
    const double inradius = 2 * area / perimeter, circumradius = lengths[0] * lengths[1] * lengths[2] / (4 * area);
    const TriangleMeasures m = measure_triangle(a, b, c);
    // Areas of thin triangles lose digits: a millionth part of a square of edge 2 leaves ten.
    const double loss = 1e-10;
    EXPECT_NEAR(m.min_angle_deg, least * 180 / std::numbers::pi, 180 * loss);
    EXPECT_NEAR(m.max_angle_deg, most * 180 / std::numbers::pi, 180 * loss);
    EXPECT_NEAR(m.equiangle_skewness, std::max((most - third) / (2 * third), (third - least) / third), loss);
    EXPECT_NEAR(m.double_inradius_to_circumradius, 2 * inradius / circumradius, loss);
  }
}

TEST(EquiangleSkewness, OfAnEmptyMeshIsZero) {
  const auto summary = summarize_skewness(TriMesh{});
  EXPECT_EQ(summary.mean, 0);
  EXPECT_EQ(summary.max, 0);
}

TEST(VertexNormals, PointOutwardsWeightedByArea) {
  TriMesh mesh = testing::icosphere(2);
  const auto normals = vertex_normals(mesh);
  // The faces around a vertex of a subdivided icosahedron lean by no more than their size, 0.3 of the radius.
  for (std::size_t v = 0; v < normals.size(); ++v) EXPECT_GT(normals[v].dot(mesh.vertices[v]), 0.99);
  // A wall of area 8 and one of area 2 at a right angle, on one vertex.
  mesh = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, -1}, {9, 9, 9}}, {{0, 1, 2}, {0, 2, 3}}};
  const Vec3 expected = Vec3(-4, 0, 16).normalized();
  EXPECT_LT((vertex_normals(mesh)[0] - expected).norm(), kRounding);
  EXPECT_EQ(vertex_normals(mesh)[4], Vec3(0, 0, 0));
}

TEST(AngleNormal, PointsMidwayBetweenTwoWallsHoweverTheyAreDivided) {
  // Half planes that meet in the x axis at a right angle; one is divided in two, the other in three.
  const Vec3 at(0, 0, 0), left(-1, 0, 0), right(3, 0, 0);
  Vec3 sum = Vec3::Zero();
  const auto add = [&](const std::vector<Vec3>& around) {
    for (std::size_t i = 0; i + 1 < around.size(); ++i) sum += angle_normal(at, around[i], around[i + 1]);
  };
  add({right, {0.3, 2, 0}, left});
  add({left, {-1, 0, -0.1}, {5, 0, -7}, right});
  EXPECT_LT((sum.normalized() - Vec3(0, -1, 1).normalized()).norm(), kRounding);
  EXPECT_NEAR(angle_normal(at, right, {0, 5, 0}).norm(), std::numbers::pi / 2, kRounding);
  EXPECT_EQ(angle_normal(at, right, 2 * right), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace vmesh
