#include "vmesh/quality/closest_point.h"

#include <limits>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "soups.h"

namespace vmesh {
namespace {

using testing::Draw;

// Coordinates are about 1 and a distance is a few dozen operations on them.
constexpr double kRounding = 1e-14;

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm();
}

// The least of the distances from the edges, and from the plane where the foot is inside.
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double edges = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  const Vec3 normal = (b - a).cross(c - a);
  if (normal.norm() < 1e-13) return edges;
  const bool inside = (b - a).cross(p - a).dot(normal) > 0 && (c - b).cross(p - b).dot(normal) > 0 &&
                      (a - c).cross(p - c).dot(normal) > 0;
  return inside ? std::min(edges, std::abs((p - a).dot(normal.normalized()))) : edges;
}

double to_mesh(const Vec3& p, const TriMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.faces) {
    least = std::min(least, to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return least;
}

TEST(ClosestPoint, IsTheLeastOverAllFaces) {
  Draw draw(1);
  for (int trial = 0; trial < 40; ++trial) {
    const TriMesh mesh = testing::random_soup(draw, 1 + draw.below(60), draw.uniform(0.01, 1));
    const ClosestPointIndex index(mesh);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.in_cube(draw.chance(0.2) ? 30 : 1.5);
      const Index near = draw.chance(0.5) ? kNone : draw.below(static_cast<Index>(mesh.faces.size()));
      const ClosestPoint found = index.closest(p, near);
      EXPECT_NEAR(found.distance, to_mesh(p, mesh), kRounding * 30);
      EXPECT_NEAR((found.point - p).norm(), found.distance, kRounding * 30);
      const auto& [a, b, c] = mesh.faces[found.face];
      EXPECT_NEAR(to_triangle(found.point, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]), 0, kRounding * 30);
    }
  }
}

TEST(ClosestPoint, IsAccurateOnNeedles) {
  const Eigen::Matrix3d turn = testing::some_rotation();
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0}) {
    for (const double apex : {0.0, 0.3, 0.999999}) {
      TriMesh mesh{{{0, 0, 0}, {1, 0, 0}, {apex, height, 0}}, {{0, 1, 2}}};
      const ClosestPointIndex index(testing::transformed(mesh, turn));
      // Above the middle of the face, and beside it in its plane: on the far side of the base.
      const Vec3 middle(apex / 2 + 0.25, height / 4, 0);
      EXPECT_NEAR(index.closest(turn * (middle + Vec3(0, 0, 0.125))).distance, 0.125, kRounding);
      EXPECT_NEAR(index.closest(turn * Vec3(0.4, -0.5, 0)).distance, 0.5, kRounding);
      EXPECT_NEAR(index.closest(turn * Vec3(-3, 0, 4)).distance, 5, 5 * kRounding);
    }
  }
}

TEST(ClosestPoint, DoesNotDependOnPlaceOrSize) {
  Draw draw(2);
  const TriMesh mesh = testing::random_soup(draw, 50, 0.3);
  const ClosestPointIndex index(mesh);
  for (const double scale : {0x1p-40, 0x1p+40}) {
    TriMesh scaled = mesh;
    for (Vec3& v : scaled.vertices) v *= scale;
    const ClosestPointIndex other(scaled);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = draw.in_cube(2);
      EXPECT_EQ(other.closest(scale * p).distance, scale * index.closest(p).distance);  // a power of two is exact
    }
  }
  const Vec3 far(0x1p30, -0x1p30, 0x1p20);
  const ClosestPointIndex moved(testing::moved(mesh, far));
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = draw.in_cube(2);
    // Coordinates of 2^30 have steps of 2^-22.
    EXPECT_NEAR(moved.closest(p + far).distance, index.closest(p).distance, 0x1p-18);
  }
}

TEST(ClosestPoint, IgnoresLooseVertices) {
  TriMesh mesh = testing::cube();
  mesh.vertices.insert(mesh.vertices.end(), {{5, 5, 5}, {NAN, 0, 0}, {1e300, 0, 0}});
  EXPECT_EQ(ClosestPointIndex(mesh).closest({5, 0.5, 0.5}).distance, 4);
}

TEST(ClosestPoint, RefusesWhatHasNoDistance) {
  EXPECT_THROW(ClosestPointIndex({}), InvalidInput);
  EXPECT_THROW(ClosestPointIndex({{{0, 0, 0}}, {}}), InvalidInput);
  EXPECT_THROW(ClosestPointIndex({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}), InvalidInput);
  for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY), 2e15}) {
    try {
      ClosestPointIndex({{{0, 0, 0}, {1, bad, 0}, {0, 1, 0}}, {{0, 2, 2}, {0, 1, 2}}});
      FAIL() << "no exception";
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("vertex 1 of face 1"), std::string::npos) << error.what();
    }
    EXPECT_THROW(ClosestPointIndex(testing::cube()).closest({0, bad, 0}), InvalidInput);
  }
}

}  // namespace
}  // namespace vmesh
