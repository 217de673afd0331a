#include <algorithm>
#include <cstring>

#include <tbb/global_control.h>

#include "vmesh/core/error.h"
#include "vmesh/solid/make_volume.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/synth/synthetic_tree.h"

#include "random_vessels.h"
#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

/// Tests of lumens, which some builds cannot fill.
class Volume : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  }
};

TEST_F(Volume, OfATube) {
  const VesselWall wall = grown_wall(tube());
  const VolumeResult result = make_volume(wall);
  expect_sound_lumen(wall, result);
  const auto faces = static_cast<std::size_t>(std::count(wall.patch.begin(), wall.patch.end(), 0u));
  EXPECT_EQ(result.mesh.wedges.size(), 4 * faces);
  EXPECT_EQ(result.mesh.pyramids.size(), 0u);
  EXPECT_EQ(result.mesh.region_names, std::vector<std::string>{"lumen"});
  EXPECT_EQ(result.mesh.patch_names, (std::vector<std::string>{"wall", "cap_1", "cap_2"}));
  EXPECT_EQ(result.layers.full_share, 1);
}

TEST_F(Volume, OfABend) {
  const VesselWall wall = grown_wall(bend(), EndShape::flat, 12);
  expect_sound_lumen(wall, make_volume(wall));
}

TEST_F(Volume, OfABifurcation) {
  for (const int around : {4, 6, 12}) {
    const VesselWall wall = grown_wall(bifurcation(), EndShape::flat, around);
    const VolumeResult result = make_volume(wall);
    expect_sound_lumen(wall, result);
    EXPECT_GE(result.layers.full_share, 0.95) << around;
  }
}

TEST_F(Volume, OfATaperingVessel) {
  const VesselWall wall = grown_wall(taper());
  expect_sound_lumen(wall, make_volume(wall));
}

TEST_F(Volume, OfTwoVesselsThatNearlyTouch) {
  const VesselWall wall = grown_wall(neighbours());
  expect_sound_lumen(wall, make_volume(wall));
}

TEST_F(Volume, OfRoundEnds) {
  const VesselWall wall = grown_wall(bifurcation(), EndShape::round);
  const VolumeResult result = make_volume(wall);
  expect_sound_lumen(wall, result);
  EXPECT_EQ(result.mesh.patch_names, std::vector<std::string>{"wall"});
  for (const BoundaryFace& face : result.mesh.boundary) EXPECT_TRUE(face.is_triangle());
}

/// A flat end of a fitted portal vein, in mm, the cap in the plane z = 0: the wall bulges over that, by .084 at the
/// last vertex of the second ring. Continued downwards to a second cap.
VesselWall bulging_over_its_cap() {
  const std::vector<std::vector<Vec3>> rings = {{{-0.729, 0.590, 0},
                                                 {-0.181, 0.917, 0},
                                                 {0.713, 0.556, 0},
                                                 {0.663, -0.746, 0},
                                                 {0.095, -0.807, 0},
                                                 {-0.562, -0.510, 0}},
                                                {{-0.840, 0.837, -0.348},
                                                 {-0.014, 0.582, -0.668},
                                                 {0.557, -0.182, -1.112},
                                                 {0.186, -0.909, -0.535},
                                                 {-0.665, -1.014, -0.191},
                                                 {-1.248, 0.008, 0.084}}};
  VesselWall wall;
  std::vector<Vec3>& vertices = wall.mesh.vertices;
  for (const auto& ring : rings) vertices.insert(vertices.end(), ring.begin(), ring.end());
  for (const Vec3& p : rings[1]) vertices.emplace_back(p.x(), p.y(), -3);
  vertices.insert(vertices.end(), {{0, 0, 0}, {-0.3, -0.1, -3}});
  wall.patch_names = {"wall", "top", "bottom"};
  const auto add = [&](Index a, Index b, Index c, Index patch) {
    wall.mesh.faces.push_back({a, b, c});
    wall.patch.push_back(patch);
  };
  for (Index i = 0; i < 6; ++i) {
    const Index j = (i + 1) % 6;
    for (const Index above : {0u, 6u}) {
      const Index below = above + 6;
      add(above + j, below + i, above + i, 0);
      add(above + j, below + j, below + i, 0);
    }
    add(j, i, 18, 1);
    add(12 + i, 12 + j, 19, 2);
  }
  wall.radius.assign(vertices.size(), 0.9);
  return wall;
}

TEST_F(Volume, WhereTheWallBulgesOverItsCap) {
  const VesselWall wall = bulging_over_its_cap();
  const VolumeResult result = make_volume(wall);
  expect_sound_lumen(wall, result);
  EXPECT_EQ(result.layers.least_share, 0);  // there is no way within the cap's plane
  EXPECT_GT(result.layers.full_share, 0.3);
}

/// A tube with open ends and a vertex next to a ring that is moved over the ring's plane, as a fit may.
GenerateResult tube_over_its_end(const Centerline& centerline) {
  GenerateOptions options;
  options.open_ends.all = true;
  GenerateResult result = generate_surface(centerline, options);
  const Opening& end = result.openings.at(1);
  for (const Triangle& face : result.mesh.faces) {
    const auto is_on_ring = [&](Index v) { return std::find(end.ring.begin(), end.ring.end(), v) != end.ring.end(); };
    if (std::count_if(face.begin(), face.end(), is_on_ring) != 2) continue;
    for (const Index v : face) {
      if (is_on_ring(v)) continue;
      Vec3& p = result.mesh.vertices[v];
      p = Vec3(20.1, 1.5 * p.y(), 1.5 * p.z());
    }
    break;
  }
  return result;
}

TEST_F(Volume, AFittedWallIsKeptBelowItsCap) {
  const Centerline centerline = tube();
  for (const bool fitted : {false, true}) {
    GenerateResult result = tube_over_its_end(centerline);
    FlatEndOptions options;
    options.fitted = fitted;
    const FlatEnds ends = finish_ends(result, centerline, options);
    ASSERT_TRUE(result.is_sound());
    MeshAttributes attributes =
        surface_attributes(result.mesh, result.binding, result.radius, result.openings, centerline);
    add_cap_labels(ends, attributes);
    const VesselWall wall = vessel_wall(result.mesh, attributes);
    const VolumeResult volume = make_volume(wall);
    expect_sound_lumen(wall, volume);
    EXPECT_EQ(volume.layers.least_share == 0, !fitted);  // whether layers end
    if (fitted) {
      EXPECT_GT(measure_volume(volume.mesh).min_dihedral_deg, 8);
    }
  }
}

TEST_F(Volume, WithoutLayersCapsKeepTheirTriangles) {
  const VesselWall wall = grown_wall(bifurcation());
  const VolumeResult result = make_volume(wall, {.layers = {}});
  expect_sound_lumen(wall, result);
  EXPECT_TRUE(result.mesh.wedges.empty());
  EXPECT_EQ(result.mesh.boundary.size(), wall.mesh.faces.size());
}

TEST_F(Volume, OfSyntheticTrees) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const VesselWall wall = grown_wall(synthetic_tree({.vertices = 60, .seed = seed}));
    const VolumeResult result = make_volume(wall);
    expect_sound_lumen(wall, result);
    EXPECT_GE(result.layers.full_share, 0.95) << seed;
  }
}

// Short, thick branches at all angles; some of their surfaces have vertices that no layer can leave.
TEST_F(Volume, OfRandomTreesWithThickLayers) {
  std::size_t pyramids = 0;
  for (const std::uint32_t seed : {5002u, 5007u, 5014u, 5019u, 5033u, 5091u}) {
    const VesselWall wall = grown_wall(plausible_tree(seed));
    const VolumeResult result = make_volume(wall, {.layers = {.count = 5, .thickness = 0.45, .growth = 1.3}});
    expect_sound_lumen(wall, result);
    pyramids += result.mesh.pyramids.size();
    for (const ThinPlace& place : result.layers.thin) {
      EXPECT_LT(place.reached_mm / place.asked_mm, kFullLayers);
      EXPECT_NE(place.limit, LayerLimit::none);
    }
  }
  EXPECT_GT(pyramids, 0u);
}

TEST_F(Volume, TheWallKeepsItsVertices) {
  const VesselWall wall = grown_wall(bifurcation(), EndShape::round);
  const VolumeResult result = make_volume(wall);
  ASSERT_GE(result.mesh.points.size(), wall.mesh.vertices.size());
  for (std::size_t v = 0; v < wall.mesh.vertices.size(); ++v) EXPECT_EQ(result.mesh.points[v], wall.mesh.vertices[v]);
}

TEST_F(Volume, SmallerCellsOnRequest) {
  const VesselWall wall = grown_wall(tube());
  const std::size_t plain = make_volume(wall).mesh.tetrahedra.size();
  const VolumeResult fine = make_volume(wall, {.core_size = 0.25});
  expect_sound_lumen(wall, fine);
  EXPECT_GT(fine.mesh.tetrahedra.size(), 4 * plain);
}

TEST_F(Volume, DoesNotDependOnTheNumberOfThreads) {
  const VesselWall wall = grown_wall(plausible_tree(5003));
  const auto make = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return make_volume(wall, {.shell = {.count = 2}}).mesh;
  };
  const VolumeMesh one = make(1), four = make(4);
  ASSERT_EQ(one.points.size(), four.points.size());
  EXPECT_EQ(std::memcmp(one.points.data(), four.points.data(), one.points.size() * sizeof(Vec3)), 0);
  EXPECT_EQ(one.tetrahedra, four.tetrahedra);
  EXPECT_EQ(one.wedges, four.wedges);
  EXPECT_EQ(one.pyramids, four.pyramids);
}

TEST_F(Volume, StopsOnRequest) {
  const VesselWall wall = grown_wall(tube());
  EXPECT_THROW(make_volume(wall, {}, [](std::string_view, double) { return false; }), Cancelled);
}

TEST(VolumeWithoutTetGen, IsRefusedButShellsAreNot) {
  if (can_mesh_lumen()) GTEST_SKIP() << "built with TetGen";
  const VesselWall wall = grown_wall(tube());
  EXPECT_THROW(make_volume(wall), Unsupported);
  EXPECT_TRUE(make_volume(wall, {.shell = {.count = 1}, .shell_only = true}).is_sound());
}

}  // namespace
}  // namespace vmesh
