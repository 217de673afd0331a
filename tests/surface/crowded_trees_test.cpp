#include <gtest/gtest.h>

#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"

#include "shared_data.h"

namespace vmesh {
namespace {

// Where branching nodes crowd together, a single seed covers some vessels twice; growth must still terminate.
class CrowdedTree : public ::testing::TestWithParam<const char*> {};

TEST_P(CrowdedTree, EndsWithABoundedNumberOfVertices) {
  VMESH_NEED_SHARED_DATA(GetParam());
  const Centerline centerline = load_centerline(testing::shared_data(GetParam())).cleaned.centerline;
  GenerateOptions options;
  options.growth = GrowthMethod::paper;
  options.sweeps = 4;  // growth is what is bounded here; the sweeps keep to the size field
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_LE(static_cast<double>(result.mesh.vertices.size()), 10 * centerline.length_in_radii());
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.euler_characteristic, 2);
}

INSTANTIATE_TEST_SUITE_P(SingleSeed, CrowdedTree,
                         ::testing::Values("liver_portal_centerlines/liverModelPatient1__bile1_1.swc",
                                           "liver_portal_centerlines/geo__Portal_Sim_Post_1.swc",
                                           "liver_portal_centerlines/liverModelPatient1__strahlerGroup8_1.swc",
                                           "brain_brava_swc/BG0002.CNG.swc", "brain_brava_swc/BG001.CNG.swc",
                                           "brain_brava_swc/BG04.CNG.swc", "brain_brava_swc/BG07.CNG.swc"));

}  // namespace
}  // namespace vmesh
