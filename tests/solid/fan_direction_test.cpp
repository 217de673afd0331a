#include "solid/fan_direction.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

double least_dot(const std::vector<Vec3>& normals, const Vec3& way) {
  double least = 1;
  for (const Vec3& normal : normals) least = std::min(least, normal.dot(way));
  return least;
}

/// The best of many directions on the sphere, or on a circle across `plane`.
double best_sampled(const std::vector<Vec3>& normals, const Vec3* plane) {
  constexpr int kSteps = 400;
  double best = -1;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const double turn = std::numbers::pi * i / kSteps;
    if (plane) {
      const Vec3 u = plane->unitOrthogonal(), v = plane->cross(u);
      best = std::max(best, least_dot(normals, std::cos(turn) * u + std::sin(turn) * v));
      continue;
    }
    for (int j = 0; j <= kSteps; ++j) {
      const double rise = std::numbers::pi * j / kSteps;
      best = std::max(
          best, least_dot(normals, {std::sin(rise) * std::cos(turn), std::sin(rise) * std::sin(turn), std::cos(rise)}));
    }
  }
  return best;
}

std::vector<Vec3> some_normals(int seed) {
  std::vector<Vec3> normals;
  for (int i = 0; i < 5 + seed % 3; ++i) {
    const double x = std::sin(7.1 * seed + 3.3 * i), y = std::cos(2.7 * seed + 1.9 * i);
    normals.push_back(Vec3(0.9 * x, 0.9 * y, 1).normalized());
  }
  return normals;
}

// Between samples the least dot product changes by at most the distance of the next one, .6 degrees.
constexpr double kSampling = 0.006;

TEST(FanDirection, SeesAllFacesAtLeastAsWellAsAnyOther) {
  for (int seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3> normals = some_normals(seed);
    const FanDirection best = best_direction(normals);
    EXPECT_NEAR(best.way.norm(), 1, 1e-12);
    EXPECT_NEAR(best.least, least_dot(normals, best.way), 1e-12);
    const double sampled = best_sampled(normals, nullptr);
    EXPECT_GE(best.least, sampled - 1e-12) << seed;
    EXPECT_LE(best.least, sampled + kSampling) << seed;
  }
}

TEST(FanDirection, StaysInThePlane) {
  const Vec3 plane = Vec3(1, 2, -0.5).normalized();
  for (int seed = 0; seed < 20; ++seed) {
    const std::vector<Vec3> normals = some_normals(seed);
    const FanDirection best = best_direction_in_plane(normals, plane);
    EXPECT_NEAR(best.way.dot(plane), 0, 1e-12);
    const double sampled = best_sampled(normals, &plane);
    EXPECT_GE(best.least, sampled - 1e-12) << seed;
    EXPECT_LE(best.least, sampled + kSampling) << seed;
  }
}

TEST(FanDirection, TellsOfAFanThatNothingSees) {
  // A saddle between four steep slopes.
  const std::vector<Vec3> normals = {Vec3(1, 0, .1).normalized(), Vec3(-1, 0, .1).normalized(),
                                     Vec3(0, 1, -.2).normalized(), Vec3(0, -1, -.2).normalized()};
  EXPECT_LE(best_direction(normals).least, 0);
}

}  // namespace
}  // namespace vmesh
