// Trees with steps shorter than thick, where thin vessels leave within the rounding between thick ones.
#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_vessels.h"
#include "sound_surface.h"

namespace vmesh {
namespace {

// Share of the vertices that are not where they belong: balanced placement lifts them by up to a sixth of the radius.
double share_off_boundary(const GenerateResult& result, const VesselField& field) {
  double off = 0;
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    const double distance = field.sample(result.mesh.vertices[v], result.binding[v].segment).distance;
    off += std::abs(distance) > 0.3 * result.radius[v];
  }
  return off / static_cast<double>(result.mesh.vertices.size());
}

TEST(ShortThickTrees, WithWideRoundingAreOnTheBoundary) {
  int hanging = 0;
  for (const double blend : {1.0, 2.0}) {
    for (std::uint32_t seed = 0; seed < 16; ++seed) {
      SCOPED_TRACE("blend " + std::to_string(blend) + ", seed " + std::to_string(seed));
      const SeparatedCenterline tree = testing::separated(testing::short_thick_tree(seed), blend);
      GenerateOptions options;
      options.blend = blend;
      const GenerateResult result = testing::honest_surface(tree.centerline, options);
      ASSERT_TRUE(result.is_sound());
      hanging += share_off_boundary(result, VesselField(tree.centerline, blend)) > 0.05;
      EXPECT_LT(result.mesh.vertices.size(), 1000U);  // 109 to 723
    }
  }
  EXPECT_LE(hanging, 1);  // on a gap, whatever the rung
}

TEST(ShortThickTrees, CanBeCancelledWithinAPiece) {
  const SeparatedCenterline tree = testing::separated(testing::short_thick_tree(3), 2);
  GenerateOptions options;
  options.blend = 2;
  options.threads = 1;
  int polls = 0;
  const auto stop_late = [&](std::string_view, double) { return ++polls < 40; };
  EXPECT_THROW(generate_surface(tree.centerline, options, stop_late), Cancelled);
  EXPECT_EQ(polls, 40);
}

}  // namespace
}  // namespace vmesh
