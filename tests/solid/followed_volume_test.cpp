#include "vmesh/solid/followed_volume.h"

#include <string>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"
#include "vmesh/surface/followed_surface.h"

#include "random_vessels.h"
#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

TEST(FollowedVolume, OnOneVesselKeepsItsShareOfTheRadius) {
  const Centerline tube = testing::tube();
  const std::vector<Vec3> points = {{10, 0, 0}, {10, 1, 0}, {10, 0, -2}, {3, 1, 1}, {0, 2, 0}};
  CenterlineEdit edit;
  edit.radius = {{1, 30, -0.5}};  // about the end at x = 20
  edit.scale = 2;
  const std::vector<Vec3> moved = follow_edit_within(points, tube, edit);
  const ChangedRadius radius(tube, edit.radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double factor = radius.factor(0, points[i].x() / 20);
    const Vec3 expected(2 * points[i].x(), 2 * factor * points[i].y(), 2 * factor * points[i].z());
    EXPECT_LT((moved[i] - expected).norm(), 1e-12) << i;
  }
}

TEST(FollowedVolume, IsNotTornBetweenBranches) {
  const Centerline centerline = bifurcation();
  CenterlineEdit edit;
  edit.radius = {{1, 12, 0.5}};
  // Across the plane x = 0, which is as far from one branch as from the other but for their radii.
  constexpr double kApart = 1e-6;
  for (double z = 14; z < 24; z += 0.05) {
    for (double x = -1.5; x < 1.5; x += 0.05) {
      const std::vector<Vec3> moved = follow_edit_within({{x, 0.3, z}, {x + kApart, 0.3, z}}, centerline, edit);
      // Continuous: stretched by no more than a few times, where a jump would be by thousands of times.
      EXPECT_LT((moved[1] - moved[0]).norm(), 20 * kApart) << x << " " << z;
    }
  }
}

/// Corners of the boundary's triangles: of the wall, and of caps within the rings of layers.
std::vector<char> on_triangles_outside(const VolumeMesh& mesh) {
  std::vector<char> is_on(mesh.points.size(), 0);
  for (const BoundaryFace& face : mesh.boundary) {
    for (std::size_t i = 0; face.is_triangle() && i < 3; ++i) is_on[face.corners[i]] = 1;
  }
  return is_on;
}

/// An edit of a random tree after which cells are turned over if every point goes its own way.
struct Study {
  std::uint32_t seed;
  Index node;
  double share;
  VolumeOptions options = {};
};

void expect_followed(const Study& study) {
  SCOPED_TRACE("seed " + std::to_string(study.seed));
  const Centerline centerline = plausible_tree(study.seed);
  VolumeMesh mesh = make_volume(grown_wall(centerline), study.options).mesh;
  CenterlineEdit edit;
  edit.radius = {{study.node, 8 * centerline.node(study.node).radius, study.share}};
  const std::vector<Vec3> alone = follow_edit_within(mesh.points, centerline, edit);
  const std::vector<Vec3> moved = follow_edit(mesh, centerline, edit);
  ASSERT_EQ(moved.size(), alone.size());
  const std::vector<char> is_outside = on_triangles_outside(mesh);
  for (std::size_t v = 0; !study.options.shell_only && v < moved.size(); ++v) {
    if (is_outside[v]) {
      EXPECT_EQ(moved[v], alone[v]) << v;
    }
  }
  mesh.points = alone;
  EXPECT_GT(inverted_cells(mesh), 0u);
  mesh.points = moved;
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_TRUE(find_volume_defects(mesh).empty());
}

// The outside of a shell goes with the wall that it is around.
TEST(FollowedVolume, CellsDoNotTurnOverBetweenWallsThatDoNotCross) {
  const VolumeOptions shell = {.shell = {.count = 2}, .shell_only = true};
  std::vector<Study> studies = {{30001, 14, -0.5, shell}, {30002, 26, 0.5, shell}, {30005, 19, 0.5, shell}};
  if (can_mesh_lumen()) studies.insert(studies.end(), {{30002, 10, -0.5}, {30008, 27, 0.5}, {30013, 19, -0.5}});
  for (const Study& study : studies) expect_followed(study);
}

// Here the wall turns by so much that layers over the mean of its faces would turn over, or have no room.
TEST(FollowedVolume, LayersLeanAndBecomeThinner) {
  const VolumeOptions shell = {.shell = {.count = 2}, .shell_only = true};
  std::vector<Study> studies = {{31010, 27, 0.5, shell}, {31026, 10, 0.5, shell}, {31032, 31, 0.5, shell}};
  if (can_mesh_lumen()) studies.insert(studies.end(), {{31000, 65, 0.5}, {31003, 8, 0.5}, {31022, 11, 0.5}});
  for (const Study& study : studies) expect_followed(study);
}

std::size_t crossings_outside(const VolumeMesh& mesh) { return self_intersections(boundary_surface(mesh).mesh).size(); }

TEST(FollowedVolume, TheOutsideOfAShellIsThinnerWhereItWouldCross) {
  const Centerline centerline = plausible_tree(31029);
  VolumeMesh mesh = make_volume(grown_wall(centerline), {.shell = {.count = 2}, .shell_only = true}).mesh;
  CenterlineEdit edit;
  edit.radius = {{28, 8 * centerline.node(28).radius, 0.5}};
  const std::vector<Vec3> moved = follow_edit(mesh, centerline, edit);
  mesh.points = follow_edit_within(mesh.points, centerline, edit);
  EXPECT_GT(crossings_outside(mesh), 0u);
  mesh.points = moved;
  EXPECT_EQ(crossings_outside(mesh), 0u);
  EXPECT_TRUE(find_volume_defects(mesh).empty());
}

TEST(FollowedVolume, TetrahedraThatWouldBecomeFlatDoNot) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  const Centerline centerline = plausible_tree(31033);
  VolumeMesh mesh = make_volume(grown_wall(centerline)).mesh;
  CenterlineEdit edit;
  edit.radius = {{12, 8 * centerline.node(12).radius, 0.5}};
  const std::vector<Vec3> alone = follow_edit_within(mesh.points, centerline, edit);
  const std::vector<Vec3> moved = follow_edit(mesh, centerline, edit);
  mesh.points = alone;
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_LT(measure_volume(mesh).min_dihedral_deg, 5);
  mesh.points = moved;
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_GT(measure_volume(mesh).min_dihedral_deg, 7.9);
}

TEST(FollowedVolume, IsThatOfItsPointsWhereNothingTurnsOver) {
  const Centerline centerline = bifurcation();
  const VolumeMesh mesh = make_volume(grown_wall(centerline), {.shell = {.count = 2}, .shell_only = true}).mesh;
  CenterlineEdit edit;
  edit.radius = {{2, 8, -0.4}};
  EXPECT_EQ(follow_edit(mesh, centerline, edit), follow_edit_within(mesh.points, centerline, edit));
}

// The wall of a vessel cannot follow into itself.
TEST(FollowedVolume, WhatCannotBeMendedGoesByItsPoints) {
  const Centerline corner = {{{{0, 0, 0}, 2}, {{0, 0, 10}, 2}, {{10, 0, 10}, 2}}, {{0, 1}, {1, 2}}};
  VolumeMesh mesh = make_volume(grown_wall(corner), {.shell = {.count = 2}, .shell_only = true}).mesh;
  CenterlineEdit edit;
  edit.radius = {{1, 16, 3}};
  const std::vector<Vec3> moved = follow_edit(mesh, corner, edit);
  EXPECT_EQ(moved, follow_edit_within(mesh.points, corner, edit));
  mesh.points = moved;
  EXPECT_GT(inverted_cells(mesh), 0u);
}

}  // namespace
}  // namespace vmesh
