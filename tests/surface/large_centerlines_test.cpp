#include "vmesh/synth/synthetic_tree.h"

#include "extremes.h"

namespace vmesh {
namespace {

// A winding vessel in steps of a fifth of its radius.
Centerline long_chain(Index count) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index n = 0; n < count; ++n) {
    const double x = 0.2 * n;
    nodes.push_back({{x, 30 * std::sin(x / 50), 30 * std::cos(x / 70)}, 1});
    if (n > 0) segments.push_back({n - 1, n});
  }
  return {std::move(nodes), std::move(segments)};
}

TEST(LongChain, OfAMillionNodesIsOneTube) {
  const Centerline centerline = long_chain(1'000'000);
  const GenerateResult result = generate_surface(centerline);
  testing::expect_valid(centerline, result);
  // As many vertices as its length in radii asks for, whatever the number of nodes: about 7 a radius.
  EXPECT_LT(static_cast<double>(result.mesh.vertices.size()), 10 * centerline.length_in_radii());
}

TEST(LargeTree, OfMoreJunctionsThanAreGrownAtOnceIsValid) {
  SyntheticTreeOptions tree;
  tree.vertices = 10'000;
  const Centerline centerline = synthetic_tree(tree);
  double told = 0;
  const GenerateResult result = generate_surface(centerline, {}, [&](std::string_view stage, double fraction) {
    if (stage == "grow") {
      EXPECT_GE(fraction, told);
      told = fraction;
    }
    return true;
  });
  EXPECT_GT(result.growth.junctions, 1024u);
  EXPECT_GT(told, 0.99);
  testing::expect_valid(centerline, result);
}

}  // namespace
}  // namespace vmesh
