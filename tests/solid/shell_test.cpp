#include "random_vessels.h"
#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

VolumeOptions shell_alone(double thickness, int layers = 2) {
  return {.shell = {.count = layers, .thickness = thickness}, .shell_only = true};
}

void expect_sound_shell(const VesselWall& wall, const VolumeResult& result) {
  for (const VolumeDefect& defect : result.defects) ADD_FAILURE() << defect.message;
  const VolumeMesh& mesh = result.mesh;
  EXPECT_EQ(inverted_cells(mesh), 0u);
  EXPECT_EQ(unmatched_faces(mesh), 0u);
  const double inside = cap_area(wall, 0);
  EXPECT_NEAR(patch_area(mesh, "lumen_wall"), inside, kSum * inside);
}

TEST(Shell, OfATubeIsAHollowCylinder) {
  const VesselWall wall = grown_wall(tube(), EndShape::flat, 24);
  const VolumeResult result = make_volume(wall, shell_alone(0.25, 3));
  expect_sound_shell(wall, result);
  EXPECT_EQ(result.mesh.patch_names,
            (std::vector<std::string>{"wall", "cap_1", "cap_2", "lumen_wall", "cap_1_wall", "cap_2_wall"}));
  EXPECT_EQ(result.mesh.region_names, std::vector<std::string>{"wall"});
  // Between radii 2 and 2.5 over 20 mm; a polygon with 24 corners cuts off 1 % of a circle.
  const double expected = std::numbers::pi * (2.5 * 2.5 - 2 * 2) * 20;
  EXPECT_NEAR(volume_within_boundary(result.mesh), expected, 0.03 * expected);
  EXPECT_NEAR(patch_area(result.mesh, "cap_1_wall"), std::numbers::pi * (2.5 * 2.5 - 2 * 2), 0.3);
}

TEST(Shell, SharesItsInnerNodesWithTheLumen) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  const VesselWall wall = grown_wall(bifurcation());
  const VolumeResult result = make_volume(wall, {.shell = {.count = 2, .thickness = 0.8, .in_mm = true}});
  expect_sound_lumen(wall, result);
  const VolumeMesh& mesh = result.mesh;
  ASSERT_EQ(mesh.region_names, (std::vector<std::string>{"lumen", "wall"}));
  const VolumeMeasures measures = measure_volume(mesh);
  const double lumen = enclosed_volume(wall.mesh);
  EXPECT_NEAR(measures.region_volume_mm3[0], lumen, kSum * lumen);
  EXPECT_NEAR(measures.region_volume_mm3[0] + measures.region_volume_mm3[1], volume_within_boundary(mesh),
              kSum * lumen);
  // The wall of the lumen is no boundary any more: all faces of the patch are outside.
  EXPECT_GT(patch_area(mesh, "wall"), 1.2 * cap_area(wall, 0));
}

TEST(Shell, IsThinnedBetweenVesselsThatNearlyTouch) {
  const VesselWall wall = grown_wall(neighbours(), EndShape::flat, 12);
  const VolumeResult result = make_volume(wall, shell_alone(0.3));
  expect_sound_shell(wall, result);
  ASSERT_FALSE(result.shell.thin.empty());
  const ThinPlace& thinnest = result.shell.thin[0];
  EXPECT_EQ(thinnest.limit, LayerLimit::room);
  EXPECT_NEAR(thinnest.position.y(), 2.1, 0.3);
  // A gap of .2 mm, half of it for each.
  EXPECT_LT(thinnest.reached_mm, 0.2);
  EXPECT_GT(thinnest.reached_mm, 0.02);
}

VolumeOptions merged_shell(double thickness) {
  VolumeOptions options = shell_alone(thickness);
  options.shell.merged = true;
  return options;
}

/// Corners of boundary faces follow each other around every point once.
std::size_t pinched_points(const VolumeMesh& mesh) {
  std::vector<std::map<Index, Index>> next(mesh.points.size());
  std::size_t repeated = 0;
  for (const BoundaryFace& face : mesh.boundary) {
    const std::size_t count = face.is_triangle() ? 3 : 4;
    for (std::size_t i = 0; i < count; ++i) {
      const Index before = face.corners[(i + count - 1) % count], after = face.corners[(i + 1) % count];
      repeated += !next[face.corners[i]].try_emplace(after, before).second;
    }
  }
  std::size_t pinched = repeated;
  for (const std::map<Index, Index>& ring : next) {
    std::size_t steps = 0;
    for (Index at = ring.empty() ? 0 : ring.begin()->first; steps < ring.size(); ++steps) {
      const auto found = ring.find(at);
      if (found == ring.end() || (at = found->second) == ring.begin()->first) break;
    }
    pinched += steps + 1 != ring.size() && !ring.empty();
  }
  return pinched;
}

TEST(Shell, OfNeighboursIsOneWhereTheyAreMerged) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  const VesselWall wall = grown_wall(neighbours(), EndShape::flat, 12);
  const VolumeResult apart = make_volume(wall, shell_alone(0.3)), result = make_volume(wall, merged_shell(0.3));
  expect_sound_shell(wall, result);
  EXPECT_EQ(pinched_points(result.mesh), 0u);
  ASSERT_EQ(result.merged.size(), 1u);
  EXPECT_NEAR(result.merged[0].position.y(), 2.1, 0.05);
  // Two circles of radius 2.6 at 4.2 have a lens of this area in common, and a web where neither has more than .6 of
  // wall; along 24 mm but for the ends' rings.
  EXPECT_GT(volume_within_boundary(result.mesh), volume_within_boundary(apart.mesh));
  EXPECT_GT(result.merged[0].volume_mm3, 1);
}

TEST(Shell, OfABifurcationFillsItsCrotchWhereWallsAreMerged) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  const VesselWall wall = grown_wall(bifurcation(), EndShape::flat, 12);
  VolumeOptions options = merged_shell(0.3);
  options.shell_only = false;
  const VolumeResult result = make_volume(wall, options);
  expect_sound_lumen(wall, result);
  EXPECT_EQ(pinched_points(result.mesh), 0u);
  ASSERT_FALSE(result.merged.empty());
  EXPECT_NEAR(result.merged[0].position.x(), 0, 0.5);
  EXPECT_GT(result.merged[0].position.z(), 16);
}

TEST(Shell, OfRandomTreesMerged) {
  if (!can_mesh_lumen()) GTEST_SKIP() << "built without TetGen";
  std::size_t merged = 0;
  for (std::uint32_t seed = 5000; seed < 5008; ++seed) {
    const VesselWall wall = grown_wall(plausible_tree(seed));
    const VolumeResult result = make_volume(wall, merged_shell(0.2));
    expect_sound_shell(wall, result);
    EXPECT_EQ(pinched_points(result.mesh), 0u) << seed;
    merged += result.merged.size();
  }
  EXPECT_GT(merged, 0u);
}

TEST(Shell, OfRandomTrees) {
  for (std::uint32_t seed = 5000; seed < 5008; ++seed) {
    const VesselWall wall = grown_wall(plausible_tree(seed));
    expect_sound_shell(wall, make_volume(wall, shell_alone(0.2)));
  }
}

}  // namespace
}  // namespace vmesh
