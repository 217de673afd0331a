#include "vmesh/centerline/simplification.h"

#include <gtest/gtest.h>

#include "draw.h"

namespace vmesh {
namespace {

using testing::Draw;

constexpr double kTolerance = 0.05;  // radii

auto a_twentieth(const Centerline& centerline) {
  return [&](Index node) { return kTolerance * centerline.node(node).radius; };
}

// Wavy, finely sampled branches between random nodes, some segments backwards, and an isolated node.
Centerline random_graph(std::uint32_t seed) {
  Draw draw(seed);
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  const Index ends = 3 + draw.below(6);
  for (Index i = 0; i < ends; ++i) nodes.push_back({draw.in_cube(20), draw.uniform(0.5, 2)});
  const Index branches = 2 + draw.below(10);
  for (Index b = 0; b < branches; ++b) {
    const Index from = draw.below(ends), to = draw.below(ends);  // loops and double branches among them
    const Index count = 3 + draw.below(60);
    const Vec3 side = draw.direction() * draw.uniform(0, 6);
    Index last = from;
    for (Index i = 1; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      Index next = to;
      if (i < count) {
        const Vec3 straight = (1 - t) * nodes[from].position + t * nodes[to].position;
        const double radius = (1 - t) * nodes[from].radius + t * nodes[to].radius;
        nodes.push_back({straight + std::sin(7 * t) * t * (1 - t) * side + draw.in_cube(0.01), radius});
        next = static_cast<Index>(nodes.size() - 1);
      }
      segments.push_back(draw.chance(0.5) ? CenterlineSegment{last, next} : CenterlineSegment{next, last});
      last = next;
    }
  }
  nodes.push_back({Vec3(100, 0, 0), 1});
  return {std::move(nodes), std::move(segments)};
}

TEST(Simplification, KeepsEverySphereWithinTheTolerance) {
  std::size_t left_out = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Centerline original = random_graph(seed);
    const SimplifiedCenterline simplified = simplify(original, a_twentieth(original));
    left_out += original.nodes().size() - simplified.centerline.nodes().size();
    double worst = 0;
    for (Index s = 0; s < simplified.centerline.segments().size(); ++s) {
      for (int k = 0; k <= 200; ++k) {
        const double t = k / 200.0;
        const auto [segment, u] = simplified.original(s, t);
        const double deviation = (simplified.centerline.point_at(s, t) - original.point_at(segment, u)).norm() +
                                 std::abs(simplified.centerline.radius_at(s, t) - original.radius_at(segment, u));
        worst = std::max(worst, deviation / original.radius_at(segment, u));
      }
    }
    EXPECT_LE(worst, kTolerance * (1 + 1e-9)) << "seed " << seed;  // rounding
    EXPECT_LE(simplified.max_deviation_relative, kTolerance);
  }
  EXPECT_GT(left_out, 10000u);
}

TEST(Simplification, KeepsTheGraph) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Centerline original = random_graph(seed);
    const SimplifiedCenterline simplified = simplify(original, [](Index) { return 1000; });
    EXPECT_EQ(simplified.centerline.component_count(), original.component_count());
    EXPECT_EQ(simplified.centerline.cycle_rank(), original.cycle_rank());
    EXPECT_TRUE(std::is_sorted(simplified.node.begin(), simplified.node.end()));
    for (Index n = 0; n < simplified.node.size(); ++n)
      EXPECT_EQ(simplified.centerline.degree(n), original.degree(simplified.node[n]));
    for (Index n = 0; n < original.nodes().size(); ++n) {
      const bool kept = std::binary_search(simplified.node.begin(), simplified.node.end(), n);
      EXPECT_TRUE(kept || original.degree(n) == 2) << "node " << n << ", seed " << seed;
    }
  }
}

TEST(Simplification, EverySegmentIsStoodForOnce) {
  const Centerline original = random_graph(5);
  const SimplifiedCenterline simplified = simplify(original, a_twentieth(original));
  std::vector<int> count(original.segments().size(), 0);
  for (const auto& piece : simplified.pieces) ++count[piece.segment];
  EXPECT_EQ(count, std::vector<int>(original.segments().size(), 1));
  const auto last = simplified.original(static_cast<Index>(simplified.centerline.segments().size()), 0);
  EXPECT_EQ(last.segment, original.segments().size());  // the node alone
}

TEST(Simplification, LeavesNothingOutWithoutATolerance) {
  const Centerline original = random_graph(3);
  const SimplifiedCenterline simplified = simplify(original, [](Index) { return 0; });
  EXPECT_EQ(simplified.centerline.nodes().size(), original.nodes().size());
  EXPECT_FALSE(simplified.is_simpler());
  EXPECT_EQ(simplified.max_deviation, 0);
}

TEST(Simplification, KeepsNodesWithoutATolerance) {
  const Centerline original = random_graph(7);
  const auto is_fixed = [](Index node) { return node % 5 == 0; };
  const SimplifiedCenterline simplified =
      simplify(original, [&](Index node) { return is_fixed(node) ? -1 : a_twentieth(original)(node); });
  EXPECT_TRUE(simplified.is_simpler());
  for (Index n = 0; n < original.nodes().size(); ++n) {
    const bool kept = std::binary_search(simplified.node.begin(), simplified.node.end(), n);
    EXPECT_TRUE(kept || !is_fixed(n)) << n;
  }
}

TEST(Simplification, OfAStraightTaperIsOneSegment) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i <= 1000; ++i) {
    nodes.push_back({Vec3(0.1 * i, 0.05 * i, 0), 2 - 0.001 * i});
    if (i > 0) segments.push_back({i - 1, i});
  }
  const SimplifiedCenterline simplified = simplify({nodes, segments}, [](Index) { return 1e-9; });  // rounding
  ASSERT_EQ(simplified.centerline.segments().size(), 1u);
  const auto place = simplified.original(0, 0.50025);
  EXPECT_EQ(place.segment, 500u);
  EXPECT_NEAR(place.t, 0.25, 1e-6);
}

}  // namespace
}  // namespace vmesh
