#include "solid/mend_cells.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/volume_check.h"

#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

void close(VolumeMesh& mesh, std::vector<std::string> regions) {
  mesh.region_names = std::move(regions);
  mesh.patch_names = {"wall"};
  for (const CellFace& face : outer_faces(mesh)) mesh.boundary.push_back({face, 0});
}

/// Six wedges around an axis, and six on top of them, each level a region. The last point alone is inside.
VolumeMesh two_storeys(std::vector<std::string> regions) {
  VolumeMesh mesh;
  for (int level = 0; level < 3; ++level) {
    for (int i = 0; i < 6; ++i) {
      const double turn = i * std::numbers::pi / 3;
      mesh.points.emplace_back(std::cos(turn), std::sin(turn), level);
    }
  }
  mesh.points.emplace_back(0, 0, 0);
  mesh.points.emplace_back(0, 0, 2);
  mesh.points.emplace_back(0, 0, 1);
  const std::array<Index, 3> center = {18, 20, 19};
  for (Index level = 0; level < 2; ++level) {
    for (Index i = 0; i < 6; ++i) {
      const Index a = 6 * level + i, b = 6 * level + (i + 1) % 6;
      mesh.wedges.push_back({center[level], a, b, center[level + 1], a + 6, b + 6});
      mesh.cell_region.push_back(level < regions.size() ? level : 0);
    }
  }
  close(mesh, std::move(regions));
  return mesh;
}

/// The faces of an octahedron and a pyramid's base, joined to a point inside.
VolumeMesh octahedron_with_a_pyramid() {
  VolumeMesh mesh;
  mesh.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, 0.3}};
  mesh.pyramids = {{0, 1, 2, 3, 5}};
  for (Index i = 0; i < 4; ++i) mesh.tetrahedra.push_back({i, (i + 1) % 4, 4, 5});
  for (Tetrahedron& cell : mesh.tetrahedra) {
    if (six_volumes(mesh, cell[0], cell[1], cell[2], cell[3]) < 0) std::swap(cell[0], cell[1]);
  }
  mesh.cell_region.assign(5, 0);
  close(mesh, {"lumen"});
  return mesh;
}

void expect_mended(VolumeMesh mesh, const Vec3& astray) {
  const VolumeMesh rest = mesh;
  ASSERT_EQ(inverted_cells(rest), 0u);
  const std::size_t inside = mesh.points.size() - 1;
  mesh.points[inside] = astray;
  ASSERT_GT(inverted_cells(mesh), 0u);
  EXPECT_EQ(mend_cells(mesh, rest.points), 1u);
  EXPECT_EQ(inverted_cells(mesh), 0u);
  for (std::size_t v = 0; v < inside; ++v) EXPECT_EQ(mesh.points[v], rest.points[v]);
}

TEST(MendCells, WedgesAreMendedByThePointInside) {
  expect_mended(two_storeys({"lumen"}), {0.2, 0.1, -0.8});
  expect_mended(two_storeys({"lumen"}), {1.4, 0, 1.1});
}

TEST(MendCells, SoAreTetrahedraAndPyramids) {
  expect_mended(octahedron_with_a_pyramid(), {0.2, 0.1, -0.5});
  expect_mended(octahedron_with_a_pyramid(), {0.9, 0.7, 0.4});
}

// None is turned over; the point inside has come close to a face outside.
TEST(MendCells, FlatTetrahedraBecomeLessFlat) {
  VolumeMesh mesh = octahedron_with_a_pyramid();
  const std::vector<Vec3> rest = mesh.points;
  mesh.points.back() = Vec3(0.32, 0.32, 0.32);
  ASSERT_EQ(inverted_cells(mesh), 0u);
  ASSERT_LT(measure_volume(mesh).min_dihedral_deg, 5);
  EXPECT_EQ(mend_cells(mesh, rest), 1u);
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_GE(measure_volume(mesh).min_dihedral_deg, 7.9);  // 8 degrees as a sine of three digits
}

TEST(MendCells, WhereRegionsMeetPointsStay) {
  for (const auto& [regions, may_move] : {std::pair<std::vector<std::string>, bool>{{"lumen", "wall"}, false},
                                          {{"lumen_3", "wall_3"}, false},
                                          {{"lumen_3", "lumen_12"}, true}}) {
    VolumeMesh mesh = two_storeys(regions);
    const std::vector<Vec3> rest = mesh.points;
    mesh.points.back().z() = -0.5;
    EXPECT_EQ(mend_cells(mesh, rest), may_move ? 1u : 0u) << regions[1];
    EXPECT_EQ(inverted_cells(mesh) == 0, may_move) << regions[1];
  }
}

TEST(MendCells, GoodCellsStayAsTheyAre) {
  VolumeMesh mesh = two_storeys({"lumen"});
  const std::vector<Vec3> rest = mesh.points;
  // All of it is turned and half as large, which changes no shape.
  const Eigen::AngleAxisd turn(1, Vec3(1, 2, 3).normalized());
  for (Vec3& p : mesh.points) p = turn * (0.5 * p) + Vec3(7, 8, 9);
  mesh.points.back() += Vec3(0.05, 0.02, 0.1);
  const std::vector<Vec3> before = mesh.points;
  EXPECT_EQ(mend_cells(mesh, rest), 0u);
  EXPECT_EQ(mesh.points, before);
}

TEST(MendCells, TheRestMustFit) {
  VolumeMesh mesh = two_storeys({"lumen"});
  EXPECT_THROW(mend_cells(mesh, {}), InvalidInput);
  const std::vector<Vec3> rest = mesh.points;
  mesh.wedges[3][2] = 1000;
  EXPECT_THROW(mend_cells(mesh, rest), InvalidInput);
}

}  // namespace
}  // namespace vmesh
