#include "vmesh/mesh/volume_faces.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "tube_volume.h"

namespace vmesh {
namespace {

using testing::tube_volume;

Vec3 centre(const VolumeMesh& mesh, const auto& corners) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const Index v : corners) {
    if (v == kNone) continue;
    sum += mesh.points[v];
    ++count;
  }
  return sum / count;
}

/// Twice the area, seen from outside.
Vec3 normal(const VolumeMesh& mesh, const CellFace& face) {
  const Vec3 &a = mesh.points[face[0]], &b = mesh.points[face[1]], &c = mesh.points[face[2]];
  if (face[3] == kNone) return (b - a).cross(c - a);
  return (c - a).cross(mesh.points[face[3]] - b);
}

TEST(VolumeFaces, FacesOfCellsLookOutwards) {
  const VolumeMesh mesh = tube_volume();
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (const CellFace& face : faces_of(t)) EXPECT_GT(normal(mesh, face).dot(centre(mesh, face) - centre(mesh, t)), 0);
  }
  ASSERT_FALSE(mesh.wedges.empty());
  for (const Wedge& w : mesh.wedges) {
    for (const CellFace& face : faces_of(w)) EXPECT_GT(normal(mesh, face).dot(centre(mesh, face) - centre(mesh, w)), 0);
  }
}

TEST(VolumeFaces, TheCellBehindAFaceHasItsCorners) {
  const VolumeMesh mesh = tube_volume();
  const std::vector<Index> behind = cells_behind_boundary(mesh);
  ASSERT_EQ(behind.size(), mesh.boundary.size());
  for (std::size_t f = 0; f < behind.size(); ++f) {
    std::vector<Index> corners;
    if (behind[f] < mesh.tetrahedra.size()) {
      corners.assign(mesh.tetrahedra[behind[f]].begin(), mesh.tetrahedra[behind[f]].end());
    } else {
      const Wedge& w = mesh.wedges.at(behind[f] - mesh.tetrahedra.size());
      corners.assign(w.begin(), w.end());
    }
    for (const Index v : mesh.boundary[f].corners) {
      if (v == kNone) continue;
      EXPECT_EQ(std::count(corners.begin(), corners.end(), v), 1) << f;
    }
  }
}

std::string boundary_error(const VolumeMesh& mesh) {
  try {
    cells_behind_boundary(mesh);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

TEST(VolumeFaces, ABoundaryThatIsNoneIsRefused) {
  VolumeMesh mesh = tube_volume();
  EXPECT_EQ(boundary_error(mesh), "none");
  const BoundaryFace first = mesh.boundary[0];
  mesh.boundary.push_back(first);
  EXPECT_NE(boundary_error(mesh).find("is there twice"), std::string::npos);
  mesh.boundary.pop_back();
  std::swap(mesh.boundary[0].corners[0], mesh.boundary[0].corners[1]);
  EXPECT_EQ(boundary_error(mesh), "face 0 of the volume's boundary is turned inwards");
  const CellFace inside = faces_of(mesh.wedges[0])[0];  // to a tetrahedron
  mesh.boundary[0] = first;
  mesh.boundary.push_back({inside, 0});
  EXPECT_NE(boundary_error(mesh).find("lies between two cells"), std::string::npos);
  mesh.boundary.back().corners = {0, 1, static_cast<Index>(mesh.points.size() - 1), kNone};
  EXPECT_NE(boundary_error(mesh).find("is no face of a cell"), std::string::npos);
}

std::string mesh_error(const VolumeMesh& mesh) {
  try {
    check_volume_mesh(mesh);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

TEST(CheckVolumeMesh, NamesWhatDoesNotFit) {
  const VolumeMesh good = tube_volume();
  EXPECT_EQ(mesh_error(good), "none");
  const auto error_of = [&](const auto& damage) {
    VolumeMesh mesh = good;
    damage(mesh);
    return mesh_error(mesh);
  };
  const std::string points = std::to_string(good.points.size());
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.tetrahedra[3][1] = 9999; }),
            "tetrahedron 3 names point 9999, but the mesh has " + points + " points");
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.wedges[2][5] = kNone; }),
            "wedge 2 names point 4294967295, but the mesh has " + points + " points");
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.boundary[1].corners[2] = 9999; }),
            "face 1 of the volume's boundary names point 9999, but the mesh has " + points + " points");
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.boundary[4].patch = 3; }),
            "face 4 of the volume's boundary is of patch 3, but there are names for 3");
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.cell_region[7] = 1; }), "cell 7 is of region 1, but there are names for 1");
  EXPECT_NE(error_of([](VolumeMesh& m) { m.cell_region.pop_back(); }).find("but regions for"), std::string::npos);
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.patch_names[2] = "wall"; }), "two patches have the name \"wall\"");
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.patch_names[0].clear(); }), "a patch of the volume mesh has no name");
  EXPECT_NE(error_of([](VolumeMesh& m) { m.patch_names[0] = "a\nb"; }).find("on one line"), std::string::npos);
}

}  // namespace
}  // namespace vmesh
