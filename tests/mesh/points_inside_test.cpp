#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

#include "draw.h"
#include "shapes.h"

namespace vmesh {
namespace {

using testing::operator+;
using testing::moved, testing::inverted, testing::tetrahedron, testing::cube, testing::icosphere, testing::torus;

TEST(PointsInside, OfACubeAreStrictlyInside) {
  const double just_in = std::nextafter(1.0, 0.0), just_out = std::nextafter(1.0, 2.0);
  const std::vector<Vec3> points = {{0.5, 0.5, 0.5},
                                    {2, 0.5, 0.5},
                                    {0.5, 0.5, 1},
                                    {1, 1, 0.25},
                                    {0, 0, 0},
                                    {1, 0.5, 0.5},
                                    {0.5, 0.5, 0},
                                    {just_in, 0.5, 0.5},
                                    {just_out, 0.5, 0.5},
                                    {0.5, 3, 0.5},
                                    {0x1p-60, 0x1p-60, 0x1p-60}};
  EXPECT_EQ(points_inside(cube(), points),
            (std::vector<bool>{true, false, false, false, false, false, false, true, false, false, true}));
}

TEST(PointsInside, OfACubeAgreeWithItsCoordinatesOnAGrid) {
  // Multiples of 1/4: rays through edges and corners, points on faces, edges and corners.
  std::vector<Vec3> points;
  std::vector<bool> expected;
  for (int i = -1; i <= 5; ++i) {
    for (int j = -1; j <= 5; ++j) {
      for (int k = -1; k <= 5; ++k) {
        points.emplace_back(i / 4.0, j / 4.0, k / 4.0);
        expected.push_back(i > 0 && i < 4 && j > 0 && j < 4 && k > 0 && k < 4);
      }
    }
  }
  EXPECT_EQ(points_inside(cube(), points), expected);
}

TEST(PointsInside, OfATorusLeaveItsHoleOut) {
  const Index along = 48, around = 32;
  testing::Draw draw(5);
  std::vector<Vec3> points = {{0, 0, 0}, {3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {4.5, 0, 0}, {0, 0, 0.5}};
  std::vector<bool> expected = {false, true, true, true, false, false};
  // The chords along the ring lie closer to the axis than their arcs, by at most 4 (1 - cos(pi / 48)) < 0.009: inwards
  // outside the ring, outwards within it. The chords around the tube lose at most 1 - cos(pi / 32) < 0.005.
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p(draw.uniform(-4.5, 4.5), draw.uniform(-4.5, 4.5), draw.uniform(-1.5, 1.5));
    const double distance = std::hypot(std::hypot(p.x(), p.y()) - 3, p.z());
    if (distance > 0.985 && distance < 1.01) continue;
    points.push_back(p);
    expected.push_back(distance < 1);
  }
  EXPECT_EQ(points_inside(torus(3, 1, along, around), points), expected);
}

TEST(PointsInside, NeitherCareForOrientationNorMixUpComponents) {
  const TriMesh two = cube() + moved(inverted(tetrahedron()), {5, 0, 0});
  EXPECT_EQ(points_inside(two, {{0.5, 0.5, 0.5}, {5.1, 0.1, 0.1}, {3, 0.1, 0.1}}),
            (std::vector<bool>{true, true, false}));
}

TEST(PointsInside, OfNoPointsAreNone) { EXPECT_TRUE(points_inside(cube(), {}).empty()); }

TEST(PointsInside, AreNotDefinedForAnOpenMesh) {
  TriMesh open = cube();
  open.faces.pop_back();
  EXPECT_THROW(points_inside(open, {{0.5, 0.5, 0.5}}), InvalidInput);
  EXPECT_THROW(points_inside({}, {{0.5, 0.5, 0.5}}), InvalidInput);
}

TEST(PointsInside, AreNotDefinedForAnEdgeWithThreeFacesOrFacesThatDisagree) {
  TriMesh three = tetrahedron();
  three.vertices.emplace_back(1, 1, 0);
  three.faces.push_back({1, 2, 4});
  EXPECT_THROW(points_inside(three, {{0.1, 0.1, 0.1}}), InvalidInput);
  TriMesh disagree = cube();
  std::swap(disagree.faces[5][0], disagree.faces[5][1]);
  EXPECT_THROW(points_inside(disagree, {{0.5, 0.5, 0.5}}), InvalidInput);
}

}  // namespace
}  // namespace vmesh
