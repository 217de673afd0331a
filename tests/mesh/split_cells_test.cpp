#include "vmesh/mesh/split_cells.h"

#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/volume_faces.h"

#include "mixed_cells.h"
#include "tube_volume.h"

namespace vmesh {
namespace {

using testing::tube_volume;

double volume_of_cell(const VolumeMesh& mesh, const Tetrahedron& t) {
  const Vec3& a = mesh.points[t[0]];
  return (mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).dot(mesh.points[t[3]] - a) / 6;
}

TEST(SplitCells, CellsMeetFaceToFaceAndFillTheSameVolume) {
  const testing::TubeSizes sizes = {.radius = 3, .length = 7, .around = 10, .along = 3, .rings = 2, .layers = 3};
  const VolumeMesh before = tube_volume(sizes);
  const SplitCells split = split_cells(before);
  EXPECT_TRUE(split.mesh.wedges.empty());
  EXPECT_EQ(split.mesh.tetrahedra.size(), before.tetrahedra.size() + 3 * before.wedges.size());
  check_volume_mesh(split.mesh);
  EXPECT_NO_THROW(sides_of_boundary(split.mesh));
  EXPECT_NO_THROW(inner_faces(split.mesh));  // throws where two cells cut a quad differently
  double volume = 0;
  for (const Tetrahedron& t : split.mesh.tetrahedra) {
    EXPECT_GT(volume_of_cell(split.mesh, t), 0);
    volume += volume_of_cell(split.mesh, t);
  }
  const double around = static_cast<double>(sizes.around);
  const double area = around / 2 * sizes.radius * sizes.radius * std::sin(2 * std::numbers::pi / around);
  EXPECT_NEAR(volume, area * sizes.length, 1e-12 * volume);  // rounding of some hundred cells
}

/// A prism over a triangle whose corners have these numbers.
VolumeMesh prism(const std::array<Index, 6>& numbers) {
  VolumeMesh mesh;
  const std::array<Vec3, 6> places = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                      Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 1)};
  mesh.points.resize(6);
  for (std::size_t i = 0; i < 6; ++i) mesh.points[numbers[i]] = places[i];
  mesh.wedges = {{numbers}};
  mesh.cell_region = {0};
  mesh.region_names = {"lumen"};
  mesh.patch_names = {"wall"};
  for (const CellFace& face : faces_of(mesh.wedges[0])) mesh.boundary.push_back({face, 0});
  return mesh;
}

TEST(SplitCells, EveryNumberingOfTheCornersGivesTetrahedraOfTheWholePrism) {
  std::array<Index, 6> numbers = {0, 1, 2, 3, 4, 5};
  do {
    const VolumeMesh mesh = prism(numbers);
    const SplitCells split = split_cells(mesh);
    double volume = 0;
    for (const Tetrahedron& t : split.mesh.tetrahedra) volume += volume_of_cell(split.mesh, t);
    EXPECT_NEAR(volume, 0.5, 1e-15);
    EXPECT_EQ(split.mesh.boundary.size(), 8u);
    EXPECT_NO_THROW(sides_of_boundary(split.mesh));  // each face of the boundary is one of a cell
    EXPECT_EQ(inner_faces(split.mesh).size(), 2u);
  } while (std::next_permutation(numbers.begin(), numbers.end()));
}

TEST(SplitCells, EveryNumberingOfMixedCellsMeetsFaceToFace) {
  std::array<Index, 8> numbers = {0, 1, 2, 3, 4, 5, 6, 7};
  do {
    const VolumeMesh mesh = testing::mixed_cells(numbers);
    const SplitCells split = split_cells(mesh);
    std::array<double, 3> volume = {};
    for (std::size_t t = 0; t < split.mesh.tetrahedra.size(); ++t)
      volume[split.cell_origins[t]] += volume_of_cell(split.mesh, split.mesh.tetrahedra[t]);
    ASSERT_NEAR(volume[1], 1.0 / 2, 1e-15);
    ASSERT_NEAR(volume[2], 1.0 / 6, 1e-15);
    ASSERT_EQ(split.mesh.tetrahedra.size(), 6u);
    ASSERT_EQ(inner_faces(split.mesh).size(), 6u);  // throws where two cells cut a quad differently
    ASSERT_NO_THROW(sides_of_boundary(split.mesh));
  } while (std::next_permutation(numbers.begin(), numbers.end()));
}

TEST(SplitCells, RegionsPatchesAndAttributesGoWithTheirCells) {
  VolumeMesh mesh = tube_volume();
  mesh.region_names = {"lumen", "layers"};
  for (std::size_t c = mesh.tetrahedra.size(); c < mesh.cell_count(); ++c) mesh.cell_region[c] = 1;
  MeshAttribute number{"number", {}, true};
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) number.values.push_back(static_cast<double>(c));
  const SplitCells split = split_cells(mesh);
  const VolumeAttributes attributes = split_attributes({{}, {number}}, split.cell_origins);
  ASSERT_EQ(attributes.cell.size(), 1u);
  EXPECT_TRUE(attributes.cell[0].integer);
  for (std::size_t c = 0; c < split.mesh.tetrahedra.size(); ++c) {
    EXPECT_EQ(split.mesh.cell_region[c], c < mesh.tetrahedra.size() ? 0u : 1u);
    const auto origin = static_cast<std::size_t>(attributes.cell[0].values[c]);
    ASSERT_EQ(origin, split.cell_origins[c]);
    for (const Index v : split.mesh.tetrahedra[c]) {
      if (origin < mesh.tetrahedra.size()) {
        EXPECT_EQ(split.mesh.tetrahedra[c], mesh.tetrahedra[origin]);
      } else {
        const Wedge& wedge = mesh.wedges[origin - mesh.tetrahedra.size()];
        EXPECT_EQ(std::count(wedge.begin(), wedge.end(), v), 1);
      }
    }
  }
  std::array<double, 3> area_before = {}, area_after = {};
  const auto add = [](const VolumeMesh& m, std::array<double, 3>& area) {
    for (const BoundaryFace& face : m.boundary) {
      const Vec3 &a = m.points[face.corners[0]], &b = m.points[face.corners[1]], &c = m.points[face.corners[2]];
      const Vec3 d = face.is_triangle() ? a : m.points[face.corners[3]];
      area[face.patch] += ((b - a).cross(c - a).norm() + (c - a).cross(d - a).norm()) / 2;
    }
  };
  add(mesh, area_before);
  add(split.mesh, area_after);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_NEAR(area_after[p], area_before[p], 1e-12 * area_before[p]) << p;
}

TEST(SplitCells, AWedgeThatIsTurnedInsideOutIsRefused) {
  VolumeMesh mesh = prism({0, 1, 2, 3, 4, 5});
  mesh.points[5] = {0, 1, -0.5};
  try {
    split_cells(mesh);
    FAIL() << "not refused";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("cell 0, at ("), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace vmesh
