#include "surface/pieces/fine_places.h"

#include <set>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

// Two vessels far apart, of radius 1 and 2.
const Centerline& vessels() {
  static const Centerline centerline{{{{0, 0, 0}, 1}, {{10, 0, 0}, 1}, {{0, 50, 0}, 2}, {{10, 50, 0}, 2}},
                                     {{0, 1}, {2, 3}}};
  return centerline;
}

ErrorLimit limit_of(double relative) {
  ErrorLimit limit;
  limit.relative = relative;
  return limit;
}

const UnprovenPlace kThin{{5, 1, 0}, 3}, kThick{{5, 52, 0}, 1};

TEST(FinePlaces, AreAsFineAsTheirVesselAndTheLimitAsk) {
  const VesselField field(vessels(), 0);
  FinePlaces fine(field, limit_of(0.01));
  ASSERT_TRUE(fine.draw({kThin, kThick}));
  ASSERT_EQ(fine.places().size(), 2u);
  const FinePlace &thin = fine.places()[0], &thick = fine.places()[1];
  EXPECT_EQ(thin.center, kThin.position);
  EXPECT_NEAR(thick.edge, 2 * thin.edge, 1e-9);  // relative limits scale with the radius
  EXPECT_NEAR(thick.reach, 2 * thin.reach, 1e-9);
  FinePlaces coarser(field, limit_of(0.04));
  coarser.draw({kThin});
  EXPECT_NEAR(coarser.places()[0].edge, 2 * thin.edge, 1e-9);  // what an edge cuts off grows as its square
}

TEST(FinePlaces, OnlyThoseThatFailAreDrawnAgain) {
  const VesselField field(vessels(), 0);
  FinePlaces fine(field, limit_of(0.01));
  fine.draw({kThin, kThick});
  const FinePlace thin = fine.places()[0], thick = fine.places()[1];
  // Two faces beside each other are one place.
  ASSERT_TRUE(fine.draw({kThin, {kThin.position + Vec3(0.1, 0, 0), 1}}));
  ASSERT_EQ(fine.places().size(), 2u);
  EXPECT_NE(fine.places()[0].edge, thin.edge);
  EXPECT_EQ(fine.places()[1].edge, thick.edge);
  EXPECT_EQ(fine.places()[1].reach, thick.reach);
}

TEST(FinePlaces, EndWhenEveryDrawHasFailed) {
  const VesselField field(vessels(), 0);
  FinePlaces fine(field, limit_of(0.01));
  EXPECT_FALSE(fine.draw({}));
  std::set<double> edges;
  std::size_t draws = 0;
  for (; fine.draw({kThin}); ++draws) {
    ASSERT_LT(draws, 100u);
    edges.insert(fine.places()[0].edge);
  }
  EXPECT_GT(draws, 1u);
  EXPECT_GT(edges.size(), draws / 2);
  EXPECT_TRUE(fine.draw({kThin, kThick}));  // a new one begins
}

}  // namespace
}  // namespace vmesh
