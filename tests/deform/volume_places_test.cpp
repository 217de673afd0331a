#include "vmesh/deform/volume_places.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// A vessel of radius 1 along x, bent at its middle node.
Centerline elbow() { return {{{{0, 0, 0}, 1}, {{4, 0, 0}, 1}, {{4, 4, 0}, 1}}, {{0, 1}, {1, 2}}}; }

/// Two layers on one triangle of a wall at z = 1, whose inner points are nearer to the second segment.
VolumeMesh two_layers() {
  VolumeMesh mesh;
  const auto triangle = [&](double x, double z) {
    for (const Vec3& p : {Vec3(x, 0, z), Vec3(x + 0.5, 0, z), Vec3(x, 0.5, z)}) mesh.points.push_back(p);
  };
  triangle(3, 1), triangle(3.2, 0.9), triangle(3.4, 0.8);
  mesh.points.emplace_back(3, 0, 0);  // of a tetrahedron
  mesh.wedges = {{3, 4, 5, 0, 1, 2}, {6, 7, 8, 3, 4, 5}};
  mesh.tetrahedra = {{6, 8, 7, 9}};
  mesh.cell_region = {0, 0, 0};
  mesh.region_names = {"lumen"};
  mesh.patch_names = {"wall"};
  mesh.boundary = {{{0, 1, 2, kNone}, 0}};
  return mesh;
}

TEST(VolumePlaces, AStackHasThePlaceOfItsVertexOnTheWall) {
  const VolumeMesh mesh = two_layers();
  const std::vector<Vec3> vertices = {mesh.points[2], mesh.points[0], mesh.points[1] + Vec3(1e-7, 0, 0)};
  const std::vector<SurfacePlace> places = {{0, 0.25}, {1, 0.5}, {1, 0.75}};
  const VolumePlaces found = volume_places(elbow(), mesh, vertices, places, 4);
  EXPECT_EQ(found.shared, 3u);
  ASSERT_EQ(found.places.size(), mesh.points.size());
  for (const std::size_t layer : {0, 3, 6}) {
    EXPECT_EQ(found.places[layer].segment, 1u);
    EXPECT_EQ(found.places[layer].t, 0.5);
    EXPECT_EQ(found.places[layer + 1].t, 0.75);
    EXPECT_EQ(found.places[layer + 2].segment, 0u);
    EXPECT_EQ(found.places[layer + 2].t, 0.25);
  }
  // The point on the axis of the first segment, at three of four millimetres.
  EXPECT_EQ(found.places[9].segment, 0u);
  EXPECT_EQ(found.places[9].t, 0.75);
}

TEST(VolumePlaces, WithoutASurfaceTheOutsideDecides) {
  VolumeMesh mesh = two_layers();
  // The inner corner lies beyond the bend.
  mesh.points[6] = {4, 1, 0.8};
  const VolumePlaces found = volume_places(elbow(), mesh, {}, {}, 4);
  EXPECT_EQ(found.shared, 0u);
  const std::vector<SurfacePlace> nearest = nearest_places(elbow(), mesh.points);
  ASSERT_EQ(nearest[6].segment, 1u);
  ASSERT_EQ(nearest[0].segment, 0u);
  for (const std::size_t layer : {0, 3, 6}) {
    EXPECT_EQ(found.places[layer].segment, nearest[0].segment);
    EXPECT_EQ(found.places[layer].t, nearest[0].t);
  }
}

TEST(VolumePlaces, RefusesMeshesAroundOtherCenterlines) {
  VolumeMesh mesh = two_layers();
  const auto message = [&](double farthest) -> std::string {
    try {
      volume_places(elbow(), mesh, {}, {}, farthest);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(4), "");
  // Ten radii before the beginning of the vessel is within its prolongation, ten beside it is not.
  mesh.points[9] = {-10, 0.5, 0};
  EXPECT_EQ(message(4), "");
  mesh.points[9] = {2, -10, 0};
  EXPECT_NE(message(4).find("point 9 at (2.000, -10.000, 0.000) is 10 local radii away"), std::string::npos)
      << message(4);
  EXPECT_EQ(message(10.5), "");
  mesh.wedges[1][2] = 99;
  EXPECT_NE(message(4).find("wedge 1: there is no point 99"), std::string::npos) << message(4);
}

TEST(VolumePlaces, OfIsolatedNodes) {
  const Centerline ball({{{0, 0, 0}, 1}, {{10, 0, 0}, 2}}, {});
  VolumeMesh mesh;
  mesh.points = {{0.5, 0, 0}, {11, 0, 0}};
  const VolumePlaces found = volume_places(ball, mesh, {}, {}, 4);
  EXPECT_EQ(found.places[0].segment, 0u);
  EXPECT_EQ(found.places[1].segment, 1u);
  mesh.points[1] = {19, 0, 0};
  EXPECT_THROW(volume_places(ball, mesh, {}, {}, 4), InvalidInput);
}

}  // namespace
}  // namespace vmesh
