#include "vmesh/mesh/volume_faces.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "mixed_cells.h"
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
  const VolumeMesh mixed = testing::mixed_cells();
  for_each_cell(mixed, [&](const auto& cell) {
    for (const CellFace& face : faces_of(cell))
      EXPECT_GT(normal(mixed, face).dot(centre(mixed, face) - centre(mixed, cell)), 0);
  });
  ASSERT_FALSE(mesh.wedges.empty());
  for (const Wedge& w : mesh.wedges) {
    for (const CellFace& face : faces_of(w)) EXPECT_GT(normal(mesh, face).dot(centre(mesh, face) - centre(mesh, w)), 0);
  }
}

TEST(VolumeFaces, TheCellBehindAFaceHasItsCorners) {
  const VolumeMesh mesh = tube_volume();
  const std::vector<CellSide> behind = sides_of_boundary(mesh);
  ASSERT_EQ(behind.size(), mesh.boundary.size());
  for (std::size_t f = 0; f < behind.size(); ++f) {
    const auto [cell, side] = behind[f];
    const bool is_tetrahedron = cell < mesh.tetrahedra.size();
    CellFace there = is_tetrahedron ? faces_of(mesh.tetrahedra[cell]).at(side)
                                    : faces_of(mesh.wedges.at(cell - mesh.tetrahedra.size())).at(side);
    CellFace here = mesh.boundary[f].corners;
    std::sort(there.begin(), there.end());
    std::sort(here.begin(), here.end());
    EXPECT_EQ(here, there) << f;
  }
}

std::string boundary_error(const VolumeMesh& mesh) {
  try {
    sides_of_boundary(mesh);
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

TEST(VolumeFaces, InnerFacesArePassedFromOwnersToNeighbours) {
  const VolumeMesh mesh = tube_volume();
  const std::vector<InnerFace> faces = inner_faces(mesh);
  EXPECT_EQ(2 * faces.size() + mesh.boundary.size(), 4 * mesh.tetrahedra.size() + 5 * mesh.wedges.size());
  const auto centre_of = [&](Index cell) {
    return cell < mesh.tetrahedra.size() ? centre(mesh, mesh.tetrahedra[cell])
                                         : centre(mesh, mesh.wedges[cell - mesh.tetrahedra.size()]);
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    EXPECT_LT(faces[f].owner, faces[f].neighbour);
    EXPECT_GT(normal(mesh, faces[f].corners).dot(centre_of(faces[f].neighbour) - centre_of(faces[f].owner)), 0);
    if (f == 0) continue;
    EXPECT_LT(std::pair(faces[f - 1].owner, faces[f - 1].neighbour), std::pair(faces[f].owner, faces[f].neighbour));
  }
}

TEST(VolumeFaces, CellsThatDoNotMeetFaceToFaceAreRefused) {
  const auto error_of = [](const VolumeMesh& mesh) -> std::string {
    try {
      inner_faces(mesh);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "none";
  };
  VolumeMesh mesh = tube_volume();
  mesh.boundary.pop_back();
  EXPECT_NE(error_of(mesh).find("belongs to no other cell and is not in the boundary"), std::string::npos);
  mesh = tube_volume();
  mesh.tetrahedra.push_back(mesh.tetrahedra[0]);
  EXPECT_NE(error_of(mesh).find("belongs to more than two cells"), std::string::npos);
  mesh = tube_volume();
  std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]);
  EXPECT_NE(error_of(mesh).find("has its two cells on the same side"), std::string::npos);
}

TEST(VolumeFaces, TheOutsideIsTheBoundary) {
  const VolumeMesh mesh = tube_volume();
  std::vector<CellFace> outside = outer_faces(mesh), expected;
  for (const BoundaryFace& face : mesh.boundary) expected.push_back(face.corners);
  for (auto* faces : {&outside, &expected}) {
    for (CellFace& face : *faces) std::sort(face.begin(), face.end());
    std::sort(faces->begin(), faces->end());
  }
  EXPECT_EQ(outside, expected);
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
  EXPECT_EQ(error_of([](VolumeMesh& m) { m.patch_names[2] = "wall"; }),
            "two patches have the name \"wall\", in upper or lower case");
  EXPECT_NE(error_of([](VolumeMesh& m) { m.patch_names[1] = "WALL"; }).find("two patches"), std::string::npos);
  const std::string longest(60, 'a');
  EXPECT_EQ(error_of([&](VolumeMesh& m) { m.patch_names[0] = longest; }), "none");
  for (const std::string& name : {std::string(), std::string("a b"), std::string("1a"), std::string("a/b"),
                                  std::string("a\"b"), std::string("\xc3\xa4"), longest + "a"})
    EXPECT_NE(error_of([&](VolumeMesh& m) { m.region_names[0] = name; }).find("cannot be the name of a region"),
              std::string::npos)
        << name;
}

}  // namespace
}  // namespace vmesh
