#include <gtest/gtest.h>

#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/generate.h"

#include "shared_data.h"

namespace vmesh {
namespace {

Centerline load(const std::string& file) { return load_centerline(testing::shared_data(file)).cleaned.centerline; }

std::size_t nodes_inside(const Centerline& centerline, const TriMesh& mesh) {
  std::vector<Vec3> positions;
  for (const auto& node : centerline.nodes()) positions.push_back(node.position);
  const auto inside = points_inside(mesh, positions);
  return static_cast<std::size_t>(std::count(inside.begin(), inside.end(), true));
}

double largest_distance(const Centerline& centerline, int around) {
  GenerateOptions options;
  options.around = around;
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_TRUE(result.is_sound());
  return measure_deviation(result.mesh, result.binding, VesselField(centerline, options.blend)).max_relative;
}

class RealLiverTree : public ::testing::TestWithParam<const char*> {};

// The paper's low-resolution row of Table 2 (mean 0.23, maximum 0.70), at a bounded number of vertices.
TEST_P(RealLiverTree, BecomesOneCleanSurfaceAtThePapersQuality) {
  const std::string file = std::string("liver_portal_centerlines/liverModelPatient1__") + GetParam() + "_1.swc";
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load(file);
  const GenerateResult result = generate_surface(centerline);
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_TRUE(self_intersections(result.mesh).empty());
  EXPECT_EQ(nodes_inside(centerline, result.mesh), centerline.nodes().size());
  const SkewnessSummary skewness = summarize_skewness(result.mesh);
  EXPECT_LE(skewness.mean, 0.23);
  EXPECT_LE(skewness.max, 0.70);
  EXPECT_LE(static_cast<double>(result.mesh.vertices.size()), 8 * centerline.length_in_radii());
}

TEST_P(RealLiverTree, IsNoWorseThanFromASingleSeed) {
  const std::string file = std::string("liver_portal_centerlines/liverModelPatient1__") + GetParam() + "_1.swc";
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load(file);
  GenerateOptions single_seed;
  single_seed.growth = GrowthMethod::paper;
  const SkewnessSummary paper = summarize_skewness(generate_surface(centerline, single_seed).mesh);
  const SkewnessSummary guided = summarize_skewness(generate_surface(centerline).mesh);
  EXPECT_LE(guided.mean, paper.mean);
  constexpr double kLeftAlone = 0.32;  // by polishing: see kGoodEnergy in optimize.cpp
  EXPECT_LE(guided.max, std::max(kLeftAlone, paper.max));
}

// Between two vessels that part slowly the boundary runs in a valley much narrower than their radii. While a sheet of
// triangles hung over it, the largest distance was .019 radii at 48 around, .023 at 24.
TEST(RealValleys, AreResolvedByTwiceAsManyVerticesAround) {
  const std::string file = "liver_portal_centerlines/liverModelPatient1__vessel_portal_1.swc";
  VMESH_NEED_SHARED_DATA(file);
  const Centerline centerline = load(file);
  EXPECT_LT(1.8 * largest_distance(centerline, 48), largest_distance(centerline, 24));
}

INSTANTIATE_TEST_SUITE_P(Foundation, RealLiverTree,
                         ::testing::Values("portal1", "portal3", "portal15", "hepatic1", "hepatic3", "hepatic15",
                                           "arterial15", "vessel_portal", "vessel_hepatic", "vessel_arterial"));

}  // namespace
}  // namespace vmesh
