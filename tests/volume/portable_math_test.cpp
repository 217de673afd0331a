#include "vmesh/core/portable_math.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace vmesh {
namespace {

/// The header promises three units; the functions of long double, which has 11 bits more, are the true values.
constexpr double kMostUnits = 3;

double units_off(double found, long double expected) {
  const double nearest = std::abs(static_cast<double>(expected));
  const double unit = std::nextafter(nearest, std::numeric_limits<double>::infinity()) - nearest;
  return static_cast<double>(std::abs(static_cast<long double>(found) - expected)) / unit;
}

void expect_near_everywhere(double (*portable)(double), long double (*exact)(long double), double low, double high) {
  static_assert(std::numeric_limits<long double>::digits > 60);
  constexpr int kSteps = 100'000;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = low + (high - low) * i / kSteps;
    ASSERT_LE(units_off(portable(x), exact(x)), kMostUnits) << "at " << x;
  }
}

TEST(PortableMath, IsAsNearAsPromised) {
  expect_near_everywhere(portable_sin, std::sin, -30, 30.1);
  expect_near_everywhere(portable_sin, std::sin, -1e-4, 1.1e-4);
  expect_near_everywhere(portable_cos, std::cos, -30, 30.1);
  expect_near_everywhere(portable_atan, std::atan, -20, 20.1);
  expect_near_everywhere(portable_atan, std::atan, -1e-6, 1.1e-6);
  expect_near_everywhere(portable_log, std::log, 1e-9, 3);
  expect_near_everywhere(portable_log, std::log, 3, 1e9);
  expect_near_everywhere(portable_log1p, std::log1p, -0.99, 20);
  expect_near_everywhere(portable_log1p, std::log1p, -1e-7, 1.1e-7);
  expect_near_everywhere(portable_expm1, std::expm1, -30, 30.1);
  expect_near_everywhere(portable_expm1, std::expm1, -1e-7, 1.1e-7);
}

TEST(PortableMath, KeepsWhatIsExact) {
  EXPECT_EQ(portable_sin(0), 0);
  EXPECT_EQ(portable_cos(0), 1);
  EXPECT_EQ(portable_log(1), 0);
  EXPECT_EQ(portable_log1p(0), 0);
  EXPECT_EQ(portable_expm1(0), 0);
  EXPECT_EQ(portable_expm1(-100), -1);
  EXPECT_EQ(portable_atan(std::numeric_limits<double>::infinity()), std::numbers::pi / 2);
  EXPECT_TRUE(std::isnan(portable_atan(std::numeric_limits<double>::quiet_NaN())));
  for (double x = -2; x < 2; x += 0.01) EXPECT_EQ(portable_atan(-x), -portable_atan(x));
}

TEST(PortableMath, AnglesAreThoseOfTwoArguments) {
  EXPECT_EQ(portable_angle(0, 0), 0);
  EXPECT_EQ(portable_angle(0, 1), 0);
  EXPECT_EQ(portable_angle(0, -1), std::numbers::pi);
  for (int i = 1; i < 1000; ++i) {
    const double angle = std::numbers::pi * i / 1000, y = std::sin(angle), x = std::cos(angle);
    // The quotient is rounded before its angle is.
    EXPECT_NEAR(portable_angle(y, x), std::atan2(y, x), 4 * std::numeric_limits<double>::epsilon() * angle + 1e-15);
  }
}

}  // namespace
}  // namespace vmesh
