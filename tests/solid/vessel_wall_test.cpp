#include "vmesh/solid/vessel_wall.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "vessels.h"

namespace vmesh {
namespace {

using testing::grown_wall;

std::string message_of(const VesselWall& wall, const VolumeOptions& options = {}) {
  try {
    make_volume(wall, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TriMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

TEST(VesselWall, TakesPatchesFromFaceNumbers) {
  MeshAttributes attributes;
  attributes.vertex = {{"radius", {1, 1, 1, 1}}};
  attributes.face = {{"ModelFaceID", {5, 1, 3, 1}, true}};
  const VesselWall wall = vessel_wall(tetrahedron(), attributes);
  EXPECT_EQ(wall.patch_names, (std::vector<std::string>{"wall", "cap_2", "cap_4"}));
  EXPECT_EQ(wall.patch, (std::vector<Index>{2, 0, 1, 0}));
}

TEST(VesselWall, PatchesNamedWallAreTheWall) {
  MeshAttributes attributes;
  attributes.vertex = {{"radius", {1, 1, 1, 1}}};
  attributes.face = {{"ModelFaceID", {1, 4, 2, 2}, true}};
  attributes.patch_names = {"inlet", "wall_0", "outlet", "Wall_7"};
  const VesselWall wall = vessel_wall(tetrahedron(), attributes);
  EXPECT_EQ(wall.patch_names, (std::vector<std::string>{"wall_0", "Wall_7", "inlet"}));
  EXPECT_EQ(wall.wall_patches, 2u);
  EXPECT_EQ(wall.patch, (std::vector<Index>{2, 1, 0, 0}));
  // Where no name tells, 1 is the wall.
  attributes.patch_names = {"lumen", "in", "out", "side"};
  EXPECT_EQ(vessel_wall(tetrahedron(), attributes).patch_names, (std::vector<std::string>{"lumen", "in", "side"}));
  attributes.patch_names = {"inlet", "outlet", "wall", "side"};
  EXPECT_THROW(vessel_wall(tetrahedron(), attributes), InvalidInput);
}

TEST(VesselWall, PartsOfTheWallAreApartInTheVolume) {
  VesselWall wall = grown_wall(testing::tube());
  const std::vector<double> whole = [&] {
    VolumeOptions shell;
    shell.shell = {.count = 1};
    shell.shell_only = true;
    return measure_volume(make_volume(wall, shell).mesh).patch_area_mm2;
  }();
  // The half beyond x = 10 is another patch.
  wall.patch_names.insert(wall.patch_names.begin() + 1, "wall_far");
  wall.wall_patches = 2;
  for (std::size_t f = 0; f < wall.patch.size(); ++f) {
    const bool is_far = wall.mesh.vertices[wall.mesh.faces[f][0]].x() > 10;
    wall.patch[f] = wall.patch[f] > 0 ? wall.patch[f] + 1 : is_far ? 1 : 0;
  }
  VolumeOptions shell;
  shell.shell = {.count = 1};
  shell.shell_only = true;
  const VolumeResult result = make_volume(wall, shell);
  EXPECT_TRUE(result.is_sound());
  EXPECT_EQ(result.mesh.patch_names,
            (std::vector<std::string>{"wall", "wall_far", "cap_1", "cap_2", "lumen_wall", "cap_1_wall", "cap_2_wall"}));
  const std::vector<double> area = measure_volume(result.mesh).patch_area_mm2;
  EXPECT_NEAR(area[0] + area[1], whole[0], 1e-9 * whole[0]);
  EXPECT_NEAR(area[0], area[1], 0.1 * area[0]);
  for (const BoundaryFace& face : result.mesh.boundary) {
    const Vec3 middle = (result.mesh.points[face.corners[0]] + result.mesh.points[face.corners[1]] +
                         result.mesh.points[face.corners[2]]) /
                        3;
    if (face.patch == 0) {
      EXPECT_LT(middle.x(), 12);
    } else if (face.patch == 1) {
      EXPECT_GT(middle.x(), 8);
    }
  }
  if (!can_mesh_lumen()) return;
  testing::expect_sound_lumen(wall, make_volume(wall));
}

TEST(VesselWall, NeedsRadiiAndGoodFaceNumbers) {
  EXPECT_THROW(vessel_wall(tetrahedron(), {}), InvalidInput);
  MeshAttributes attributes;
  attributes.vertex = {{"radius", {1, 1, 0, 1}}};
  EXPECT_THROW(vessel_wall(tetrahedron(), attributes), InvalidInput);
  attributes.vertex[0].values[2] = 1;
  attributes.face = {{"ModelFaceID", {0, 1, 1, 1}, true}};
  EXPECT_THROW(vessel_wall(tetrahedron(), attributes), InvalidInput);
}

TEST(VesselWall, SurfacesThatBoundNoVolumeAreRefused) {
  VesselWall open = grown_wall(testing::tube(), EndShape::round);
  open.mesh.faces.pop_back();
  open.patch.pop_back();
  EXPECT_NE(message_of(open).find("open"), std::string::npos);

  VesselWall turned = grown_wall(testing::tube(), EndShape::round);
  for (Triangle& face : turned.mesh.faces) std::swap(face[0], face[1]);
  EXPECT_NE(message_of(turned).find("inside out"), std::string::npos);

  VesselWall crossing = grown_wall(testing::tube(), EndShape::round);
  for (Vec3& p : crossing.mesh.vertices) {
    if (std::abs(p.x() - 10) > 2) continue;
    p = {p.x(), -1.5 * p.y(), -1.5 * p.z()};  // through the opposite wall
    break;
  }
  EXPECT_NE(message_of(crossing).find("cross"), std::string::npos);
}

TEST(VesselWall, CapsMustBeFlatDiscs) {
  VesselWall bent = grown_wall(testing::tube());
  for (Index f = 0; f < bent.patch.size(); ++f) {
    if (bent.patch[f] != 1) continue;
    bent.mesh.vertices[bent.mesh.faces[f][2]].x() -= 0.2;
    break;
  }
  EXPECT_NE(message_of(bent).find("cap_1 is not flat"), std::string::npos) << message_of(bent);

  VesselWall both = grown_wall(testing::tube());
  for (Index& patch : both.patch) patch = std::min<Index>(patch, 1);
  EXPECT_NE(message_of(both).find("not a disc"), std::string::npos) << message_of(both);
}

TEST(VesselWall, OptionsOutOfRangeAreRefused) {
  const VesselWall wall = grown_wall(testing::tube());
  EXPECT_NE(message_of(wall, {.layers = {.count = -1}}), "");
  EXPECT_NE(message_of(wall, {.layers = {.count = kMostLayers + 1}}), "");
  EXPECT_NE(message_of(wall, {.layers = {.count = 2, .thickness = 0}}), "");
  EXPECT_NE(message_of(wall, {.layers = {.count = 2, .growth = 0}}), "");
  EXPECT_NE(message_of(wall, {.layers = {.count = 2, .first_mm = -1}}), "");
  EXPECT_NE(message_of(wall, {.shell_only = true}), "");
  EXPECT_NE(message_of(wall, {.core_size = -1}), "");
}

}  // namespace
}  // namespace vmesh
