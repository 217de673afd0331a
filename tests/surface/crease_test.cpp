// Where the boundary bends sharply.
#include "surface/proof/crease.h"

#include <random>

#include <gtest/gtest.h>

#include "centerlines.h"
#include "surface/proof/by_slope.h"

namespace vmesh {
namespace {

constexpr double kLimit = 0.01;

BoundaryPoint on_boundary(const VesselField& field, const Vec3& p, Index hint) {
  const BoundaryPoint at = onto_boundary(field, p, hint, 1e-6, 0);
  return {at.position, field.sample(at.position, at.sample.cone)};
}

// A thin vessel in the groove between two thick ones, blended with either.
Centerline vessel_in_a_groove() {
  return {{{{0, 0, 0}, 3.18},
           {{0.59, -1.32, -1.72}, 1.91},
           {{3.25, -6.3, -5.09}, 1.76},
           {{-0.07, -4.65, -6.32}, 3.07},
           {{0.39, -12.21, -16.83}, 3.23},
           {{3.49, -6.97, -6.95}, 0.534},
           {{3.95, -7.16, -8.63}, 0.516},
           {{3.1, -7.18, -5.32}, 1.61},
           {{2.82, -8.36, -5.65}, 1.9},
           {{3.2, -12.18, -6.32}, 1.86}},
          {{0, 1}, {1, 2}, {0, 3}, {3, 4}, {2, 5}, {5, 6}, {2, 7}, {7, 8}, {8, 9}}};
}

TEST(Kink, IsWhereTwoWallsMeet) {
  const Centerline centerline = testing::fork(50);
  const VesselField field(centerline, 0);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0.02, 0.2);
  int found = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 above(1.5 + 10 * uniform(random), 0, 10 * (uniform(random) - 0.1));
    const BoundaryPoint a = on_boundary(field, above + Vec3(0, uniform(random), 0), 1);
    const BoundaryPoint b = on_boundary(field, above - Vec3(0, uniform(random), 0), 3);
    const auto kink = onto_kink(field, a, b, kLimit);
    if (!kink) continue;
    ++found;
    // The planes of both walls beside it are within a tenth of the limit; the walls bend a little.
    for (const Index daughter : {1u, 3u})
      EXPECT_NEAR(field.sample_cone(kink->position, daughter).distance, 0, 0.5 * kLimit);
  }
  EXPECT_GT(found, 20);
}

TEST(Kink, IsNotOnARoundWall) {
  const Centerline tube{{{{0, 0, 0}, 1}, {{8, 0, 0}, 1}}, {{0, 1}}};
  const VesselField field(tube, 0.5);
  const BoundaryPoint a = on_boundary(field, {4, 0, 1}, 0);
  for (const double across : {0.1, 0.5, 0.9})
    EXPECT_FALSE(onto_kink(field, a, on_boundary(field, {4.1, across, 1}, 0), kLimit)) << across;
}

TEST(Kink, IsWhereOneBlendTakesOverFromAnother) {
  const Centerline centerline = vessel_in_a_groove();
  const VesselField field(centerline, 0.5);
  const Vec3 place(3.108, -7.21, -7.546);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  const auto near = [&] { return Vec3(place + Vec3(uniform(random), uniform(random), uniform(random))); };
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const BoundaryPoint a = on_boundary(field, near(), 4), b = on_boundary(field, near(), 4);
    const auto kink = onto_kink(field, a, b, kLimit);
    if (!kink) continue;
    ++found;
    const Vec3& p = kink->position;
    EXPECT_LT(std::abs(distance_by_slope(field.sample(p, 4))), 0.1 * kLimit);
    const Vec3 on_first = field.sample(p + 0.2 * (a.position - p), 4).gradient.normalized();
    const Vec3 on_second = field.sample(p + 0.2 * (b.position - p), 4).gradient.normalized();
    EXPECT_LT(on_first.dot(on_second), 0.95);
  }
  EXPECT_GT(found, 10);
}

}  // namespace
}  // namespace vmesh
