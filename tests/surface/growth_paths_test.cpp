#include "surface/paper/growth_paths.h"

#include <gtest/gtest.h>

#include "centerlines.h"

namespace vmesh {
namespace {

TEST(GrowthPaths, RunAwayFromTheSeed) {
  const Centerline centerline = testing::fork();  // 0 - 1 - 2 - 3, 1 - 4 - 5
  GrowthPaths paths(centerline);
  paths.start_at(2);
  EXPECT_EQ(paths.direction(0), -1);
  EXPECT_EQ(paths.direction(1), -1);
  EXPECT_EQ(paths.direction(2), 1);
  EXPECT_EQ(paths.direction(3), 1);
  EXPECT_EQ(paths.direction(4), 1);
}

TEST(GrowthPaths, MeasureDepthAlongTheWay) {
  const Centerline centerline = testing::fork();
  GrowthPaths paths(centerline);
  paths.start_at(2);
  EXPECT_NEAR(paths.depth(1, 1), 0, 1e-12);
  EXPECT_NEAR(paths.depth(1, 0), 5, 1e-12);
  EXPECT_NEAR(paths.depth(0, 0.25), 5 + 0.75 * 8, 1e-12);
  EXPECT_NEAR(paths.depth(4, 1), 15, 1e-12);
}

TEST(GrowthPaths, RememberHowFarASegmentIsCovered) {
  const Centerline centerline = testing::straight_tube();
  GrowthPaths paths(centerline);
  paths.start_at(0);
  EXPECT_EQ(paths.reached(1), 4);
  paths.advance(1, 6);
  paths.advance(1, 5);
  EXPECT_EQ(paths.reached(1), 6);
  EXPECT_EQ(paths.reached(0), 0);
  EXPECT_EQ(paths.crossings(1), 2);
  EXPECT_EQ(paths.crossings(0), 0);
}

TEST(GrowthPaths, CutALoopOnce) {
  const Centerline centerline = testing::ring(7);
  GrowthPaths paths(centerline);
  paths.start_at(3);
  int cuts = 0;
  for (Index s = 0; s < 7; ++s) cuts += paths.direction(s) == 0;
  EXPECT_EQ(cuts, 1);
}

}  // namespace
}  // namespace vmesh
