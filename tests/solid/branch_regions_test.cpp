#include "vmesh/solid/branch_regions.h"

#include <set>

#include "vmesh/core/error.h"

#include "vessels.h"

namespace vmesh {
namespace {

/// Of a point: the branch of the segment whose axis is nearest, in radii of a vessel that has one everywhere.
Index nearest_branch(const Centerline& centerline, const Vec3& p) {
  Index nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    for (int i = 0; i <= 1000; ++i) {
      const double distance = (p - centerline.point_at(s, i / 1000.0)).norm();
      if (distance < least) least = distance, nearest = s;
    }
  }
  return nearest;
}

/// Three vessels of one radius, each a branch of one segment.
Centerline star() {
  return {{{{0, 0, 0}, 2}, {{0, 0, -20}, 2}, {{14, 0, 14}, 2}, {{-14, 0, 14}, 2}}, {{0, 1}, {0, 2}, {0, 3}}};
}

TEST(BranchRegions, AreThoseOfTheNearestVessels) {
  const Centerline centerline = star();
  VolumeOptions options;
  options.shell = {.count = 2};
  options.shell_only = true;
  VolumeMesh mesh = make_volume(testing::grown_wall(centerline), options).mesh;
  const std::vector<Index> branch = branches_of_cells(mesh, centerline);
  ASSERT_EQ(branch.size(), mesh.cell_count());
  std::size_t differ = 0;
  for (Index c = 0; c < mesh.wedges.size(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : mesh.wedges[c]) middle += mesh.points[v] / 6;
    differ += nearest_branch(centerline, middle) != branch[mesh.tetrahedra.size() + c];
  }
  // Rounding between vessels of one radius does not prefer one: only what is as near to two may differ.
  EXPECT_LE(differ, mesh.wedges.size() / 500);
  const VolumeMeasures before = measure_volume(mesh);
  divide_regions(mesh, branch);
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"wall_0", "wall_1", "wall_2"}));
  EXPECT_TRUE(find_volume_defects(mesh).empty());
  const VolumeMeasures after = measure_volume(mesh);
  double sum = 0;
  for (const double volume : after.region_volume_mm3) sum += volume;
  EXPECT_NEAR(sum, before.region_volume_mm3[0], 1e-9 * sum);
  // Vessels as long as each other, but for how they end and meet.
  for (const double volume : after.region_volume_mm3) EXPECT_NEAR(volume, sum / 3, 0.1 * sum / 3);
}

TEST(BranchRegions, EveryRegionIsDividedByItself) {
  VolumeMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra.assign(5, {0, 1, 2, 3});
  mesh.cell_region = {1, 0, 1, 0, 0};
  mesh.region_names = {"lumen", "wall"};
  divide_regions(mesh, {7, 10, 2, 2, 10});
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"lumen_2", "lumen_10", "wall_2", "wall_7"}));
  EXPECT_EQ(mesh.cell_region, (std::vector<Index>{3, 1, 2, 0, 1}));
  EXPECT_THROW(divide_regions(mesh, {1, 2}), InvalidInput);
}

}  // namespace
}  // namespace vmesh
