// Locality found region by region is the same as in one go.
#include "volume/segment_locality_regions.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "random_vessels.h"

namespace vmesh {
namespace {

LocalityPairs::Pairs sorted(const PairSet& set) {
  LocalityPairs::Pairs pairs(set.pairs().begin(), set.pairs().end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

LocalityPairs::Pairs sorted(LocalityPairs::Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Returns whether there was more than one region.
bool expect_same_by_regions(const Centerline& centerline, double blend, std::size_t region_size) {
  const SegmentLocality whole = segment_locality(centerline, blend);
  const LocalityPairs parts = segment_locality_by_regions(centerline, blend, region_size);
  EXPECT_TRUE(sorted(parts.local) == sorted(whole.local));
  EXPECT_TRUE(sorted(parts.parting) == sorted(whole.parting));
  EXPECT_TRUE(sorted(parts.apart) == sorted(whole.apart));
  EXPECT_EQ(parts.rounding, whole.rounding);
  // In one go, pairs come in the order in which they are found.
  return parts.local != LocalityPairs::Pairs(whole.local.pairs().begin(), whole.local.pairs().end());
}

TEST(SegmentLocalityByRegions, IsThatOfTheWhole) {
  int several = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    for (const double blend : {0.5, 0.0, 2.0}) {
      several += expect_same_by_regions(testing::noisy_tree(seed), blend, 10);
      several += expect_same_by_regions(testing::plausible_tree(seed, seed % 3), blend, 5);
    }
  }
  EXPECT_GE(several, 200);
}

// Vessels as far from each other as they are long, one component each: as many regions.
TEST(SegmentLocalityByRegions, OfSeveralComponents) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const Centerline tree = testing::noisy_tree(seed);
    const auto first = static_cast<Index>(nodes.size());
    for (const CenterlineNode& n : tree.nodes()) nodes.push_back({n.position + Vec3(0, 1000.0 * seed, 0), n.radius});
    for (const auto& [a, b] : tree.segments()) segments.push_back({a + first, b + first});
    nodes.push_back({Vec3(500, 1000.0 * seed, 0), 1});
  }
  EXPECT_TRUE(expect_same_by_regions({nodes, segments}, 0.5, 100));
}

}  // namespace
}  // namespace vmesh
