#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"

#include "shared_data.h"
#include "sound_surface.h"

namespace vmesh {
namespace {

// Readable files are meshed or refused with a reason: the number of vertices stays in proportion to length and radii,
// whatever the radii are.
TEST(AdversarialSwc, MeshesOrRefusesWithinBounds) {
  VMESH_NEED_SHARED_DATA("adversarial_swc_neurom");
  std::set<std::string> refused;
  for (const auto& entry : std::filesystem::directory_iterator(testing::shared_data("adversarial_swc_neurom"))) {
    if (entry.path().extension() != ".swc") continue;
    SCOPED_TRACE(entry.path().filename());
    try {
      const Centerline centerline = load_centerline(entry.path()).cleaned.centerline;
      const GenerateResult result =
          testing::honest_surface(testing::separated(centerline, GenerateOptions().blend).centerline);
      EXPECT_TRUE(result.is_sound());
      const Topology topology = measure_topology(result.mesh);
      EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
      // Grown at up to 4 vertices per unit, 7 expected, 1.5 times their sum allowed, and a ball for every component.
      const double balls = 200.0 * static_cast<double>(centerline.component_count());
      EXPECT_LE(static_cast<double>(result.mesh.vertices.size()), 17 * centerline.length_in_radii() + balls);
    } catch (const InvalidInput&) {
      refused.insert(entry.path().filename());
    }
  }
  EXPECT_EQ(refused, (std::set<std::string>{"Neuron-monotonic.swc",        // radius 1e-9 over metres of radii
                                            "Neuron_missing_ids.swc",      // unknown parents
                                            "Neuron_missing_parents.swc",  // unknown parents
                                            "repeated_id.swc"}));
}

}  // namespace
}  // namespace vmesh
