// What guided growth guarantees, on graphs made to break it. VMESH_RANDOM_GRAPHS of them.
#include "random_graphs.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

constexpr std::uint32_t kCount = VMESH_RANDOM_GRAPHS;
constexpr double kTouching = 0.1;       // smaller radii, the default of --gap
constexpr double kPerNode = 40;         // vertices: a junction of one node with its docked ends, or a cap
constexpr double kTangledShare = 0.01;  // of the graphs; they name their tangles

struct Outcome {
  bool tangled = false;
  bool says_so = false;
};

Outcome expect_guarantees(const Centerline& centerline) {
  GenerateOptions options;
  options.threads = 1;
  const GenerateResult result = generate_surface(centerline, options);
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
  Outcome outcome;
  outcome.tangled = !self_intersections(result.mesh).empty();
  const bool touches = !find_contacts(VesselField(centerline, options.blend), kTouching).empty();
  outcome.says_so = touches || !result.warnings.empty();
  return outcome;
}

TEST(RandomGraphs, BecomeSurfacesOfTheirTopology) {
  std::uint32_t tangled = 0;
  for (std::uint32_t seed = 0; seed < kCount; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::optional<Centerline> centerline;
    try {
      centerline.emplace(testing::random_graph(seed));
    } catch (const InvalidInput&) {
      continue;  // two nodes at one place
    }
    const Outcome outcome = expect_guarantees(*centerline);
    if (!outcome.tangled) continue;
    EXPECT_TRUE(outcome.says_so);
    ++tangled;
  }
  EXPECT_LE(tangled, kTangledShare * kCount);
}

}  // namespace
}  // namespace vmesh
