// What guided growth guarantees, on graphs made to break it. VMESH_RANDOM_GRAPHS of them, in eight tests that run at
// the same time.
#include "random_graphs.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"

#include "sound_surface.h"

namespace vmesh {
namespace {

constexpr std::uint32_t kCount = VMESH_RANDOM_GRAPHS;
constexpr std::uint32_t kParts = 8;
constexpr double kPerNode = 40;  // vertices: a junction of one node with its docked ends, or a cap

// Whatever touches, the topology is right, and the surface is sound or lists its defects.
void expect_guarantees(const Centerline& centerline) {
  const GenerateResult result = testing::honest_surface(centerline);
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, centerline.component_count());
  EXPECT_EQ(topology.components, result.growth.components);
  EXPECT_EQ(topology.genus, static_cast<int>(result.growth.cycle_rank));
  EXPECT_LE(result.growth.cycle_rank, centerline.cycle_rank());
  std::size_t left_out = 0;  // every missing loop has been reported
  for (const auto& note : result.growth.simplifications)
    left_out += note.kind != GrowthSimplification::Kind::merged_nodes;
  EXPECT_TRUE(result.growth.cycle_rank == centerline.cycle_rank() || left_out > 0);
  EXPECT_LE(static_cast<double>(result.mesh.vertices.size()),
            8 * centerline.length_in_radii() + kPerNode * static_cast<double>(centerline.nodes().size()));
}

class RandomGraphs : public ::testing::TestWithParam<std::uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Part, RandomGraphs, ::testing::Range(0u, kParts));

TEST_P(RandomGraphs, BecomeSurfacesOfTheirTopology) {
  for (std::uint32_t seed = GetParam(); seed < kCount; seed += kParts) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::optional<Centerline> centerline;
    try {
      centerline.emplace(testing::random_graph(seed));
    } catch (const InvalidInput&) {
      continue;  // two nodes at one position
    }
    expect_guarantees(*centerline);
    testing::expect_sound_or_refused_with_reason(*centerline);
  }
}

}  // namespace
}  // namespace vmesh
