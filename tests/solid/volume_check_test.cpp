#include "vmesh/solid/volume_check.h"

#include "vmesh/core/error.h"

#include "vessels.h"

namespace vmesh {
namespace {

/// The unit cube's lower half as a wedge, a pyramid on one of its sides and a tetrahedron on that.
VolumeMesh three_cells() {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.5, -1, 0.5}, {0.5, -1, 2}};
  mesh.wedges = {{0, 1, 2, 3, 4, 5}};
  mesh.pyramids = {{1, 4, 3, 0, 6}};
  mesh.tetrahedra = {{3, 6, 4, 7}};
  mesh.region_names = {"lumen"};
  mesh.patch_names = {"wall"};
  mesh.cell_region = {0, 0, 0};
  mesh.boundary = {{{0, 2, 1, kNone}, 0}, {{3, 4, 5, kNone}, 0}, {{1, 2, 5, 4}, 0},    {{2, 0, 3, 5}, 0},
                   {{1, 4, 6, kNone}, 0}, {{3, 0, 6, kNone}, 0}, {{0, 1, 6, kNone}, 0}};
  return mesh;
}

/// With the faces of the tetrahedron, whatever its orientation.
VolumeMesh with_tetrahedron_faces(VolumeMesh mesh) {
  mesh.boundary.push_back({{3, 6, 7, kNone}, 0});
  mesh.boundary.push_back({{6, 4, 7, kNone}, 0});
  mesh.boundary.push_back({{4, 3, 7, kNone}, 0});
  return mesh;
}

bool has(const std::vector<VolumeDefect>& defects, VolumeDefectKind kind) {
  return std::any_of(defects.begin(), defects.end(), [&](const VolumeDefect& defect) { return defect.kind == kind; });
}

TEST(VolumeCheck, FindsNothingInASoundMesh) {
  const VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  for (const VolumeDefect& defect : find_volume_defects(mesh)) ADD_FAILURE() << defect.message;
  EXPECT_EQ(testing::inverted_cells(mesh), 0u);
}

TEST(VolumeCheck, FindsCellsThatAreTurnedOver) {
  VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  mesh.points[7] = {0.5, -1, -2};
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::inverted_cell));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.points[5] = {0, 1, -0.1};  // one corner of the wedge below its base
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::inverted_cell));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.points[6] = {0.5, 0.1, 0.5};  // the tip of the pyramid on the other side of its base
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::inverted_cell));
}

TEST(VolumeCheck, InvertedCellsAloneAreThoseAmongTheDefects) {
  VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  EXPECT_EQ(find_inverted_cells(mesh).count, 0u);
  mesh.points[6] = {0.5, 0.1, 0.5};  // the tip of the pyramid, a corner of the tetrahedron
  const VolumeDefect inverted = find_inverted_cells(mesh);
  EXPECT_EQ(inverted.kind, VolumeDefectKind::inverted_cell);
  EXPECT_EQ(inverted.count, testing::inverted_cells(mesh));
  EXPECT_GT(inverted.count, 0u);
  EXPECT_EQ(inverted.message, find_volume_defects(mesh).front().message);
  mesh.tetrahedra[0][1] = 99;
  EXPECT_THROW(find_inverted_cells(mesh), InvalidInput);
}

TEST(VolumeCheck, JacobiansAreTheLeastOfEveryCell) {
  const VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  const std::vector<double> least = least_jacobians_mm3(mesh);
  ASSERT_EQ(least.size(), 3u);
  const auto& [a, b, c, d] = mesh.tetrahedra[0];
  EXPECT_NEAR(least[0], testing::six_volumes(mesh, a, b, c, d), 1e-12);
  // A right prism over half of a unit square: constant, twice its volume. The pyramid over a unit square of height 1:
  // at every corner of its base 1.
  EXPECT_NEAR(least[1], 1, 1e-12);
  EXPECT_NEAR(least[2], 1, 1e-12);
  VolumeMesh turned = mesh;
  turned.points[7] = {0.5, -1, -2};
  EXPECT_LT(least_jacobians_mm3(turned)[0], 0);
  turned = mesh;
  turned.points[5] = {0, 1, 0.25};  // there the prism is a quarter as high
  EXPECT_NEAR(least_jacobians_mm3(turned)[1], testing::least_determinant(turned, turned.wedges[0]), 1e-12);
}

// Corners alone do not tell: all six determinants there are positive, one in between is not.
TEST(VolumeCheck, FindsWedgesThatTurnOverBetweenTheirCorners) {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.95, 0.05, 1}, {0.05, -0.95, 1}};
  mesh.wedges = {{0, 1, 2, 3, 4, 5}};
  double corners = std::numeric_limits<double>::infinity();
  for (const double w : {0.0, 1.0}) {
    for (const auto& [s, t] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, 1.0}})
      corners = std::min(corners, testing::wedge_determinant(mesh, mesh.wedges[0], s, t, w));
  }
  ASSERT_GT(corners, 0);
  ASSERT_LT(testing::least_determinant(mesh, mesh.wedges[0]), 0.01);
  mesh.cell_region = {0};
  mesh.region_names = {"lumen"};
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::inverted_cell));
}

TEST(VolumeCheck, FindsFacesWithoutACellOnEitherSide) {
  VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  mesh.boundary.pop_back();
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::not_conforming));
  mesh = with_tetrahedron_faces(three_cells());
  std::swap(mesh.boundary[0].corners[0], mesh.boundary[0].corners[1]);
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::not_conforming));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.pyramids.clear();
  mesh.cell_region.pop_back();
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::not_conforming));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.wedges[0][5] = 99;
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::not_conforming));
}

TEST(VolumeCheck, FindsWrongLabelsAndCrossingBoundaries) {
  VolumeMesh mesh = with_tetrahedron_faces(three_cells());
  mesh.cell_region[1] = 1;
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::wrong_label));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.boundary[2].patch = 1;
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::wrong_label));
  mesh = with_tetrahedron_faces(three_cells());
  mesh.points[7] = {0.4, 3, 0.6};
  EXPECT_TRUE(has(find_volume_defects(mesh), VolumeDefectKind::crossing_faces));
}

TEST(VolumeCheck, ComparesWithTheSurface) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  const VesselWall wall = testing::grown_wall(testing::tube());
  VolumeMesh mesh = make_volume(wall).mesh;
  EXPECT_TRUE(compare_with_wall(mesh, "lumen", wall).empty());
  mesh.points[0] *= 1.001;
  EXPECT_TRUE(has(compare_with_wall(mesh, "lumen", wall), VolumeDefectKind::other_boundary));
}

TEST(VolumeMeasures, OfARegularTetrahedronAndOfCells) {
  VolumeMesh mesh;
  mesh.points = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.cell_region = {0};
  mesh.region_names = {"lumen"};
  if (volume_of(mesh, mesh.tetrahedra[0]) < 0) std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]);
  const VolumeMeasures measures = measure_volume(mesh);
  EXPECT_NEAR(measures.min_dihedral_deg, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(measures.max_dihedral_deg, measures.min_dihedral_deg, 1e-9);
  EXPECT_NEAR(measures.least_radius_ratio, 1, 1e-12);
  EXPECT_NEAR(measures.region_volume_mm3[0], 8.0 / 3, 1e-12);
  const VolumeMesh cells = three_cells();
  EXPECT_NEAR(volume_of(cells, cells.wedges[0]), 0.5, 1e-12);
  EXPECT_NEAR(volume_of(cells, cells.pyramids[0]), 1.0 / 3, 1e-12);
}

}  // namespace
}  // namespace vmesh
