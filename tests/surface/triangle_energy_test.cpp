#include "vmesh/mesh/triangle_energy.h"

#include <gtest/gtest.h>

namespace vmesh {
namespace {

const Vec3 kB(1, 0.1, 0), kC(0.3, 1.1, 0.2);

double energy_at(const Vec3& x) {
  const double ratio = inverse_mean_ratio(x, kB, kC);
  return ratio * ratio;
}

TEST(InverseMeanRatio, IsOneForAnEquilateralTriangle) {
  EXPECT_DOUBLE_EQ(inverse_mean_ratio({0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}), 1);
}

TEST(InverseMeanRatio, IsKnownForARightTriangle) {
  // Edges 1, 1, sqrt 2, area 1/2: (1 + 1 + 2) / (4 sqrt(3) / 2).
  EXPECT_DOUBLE_EQ(inverse_mean_ratio({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 2 / std::sqrt(3.0));
}

TEST(InverseMeanRatio, IsInfiniteForADegenerateTriangle) {
  EXPECT_TRUE(std::isinf(inverse_mean_ratio({0, 0, 0}, {1, 0, 0}, {2, 0, 0})));
}

TEST(PlanarEnergy, HasTheValueAndSlopeOfTheSquaredRatio) {
  const Vec3 x(0.05, -0.1, 0.1), u = Vec3(1, 0.2, 0.1).normalized(), w = u.cross(Vec3(0.1, 0.3, 1)).normalized();
  PlanarEnergy energy;
  energy.add(x, kB, kC, u, w);
  EXPECT_DOUBLE_EQ(energy.value, energy_at(x));
  const double h = 1e-6;  // central differences: error h^2 times the third derivative, and 1e-16 / h
  EXPECT_NEAR(energy.gradient.x(), (energy_at(x + h * u) - energy_at(x - h * u)) / (2 * h), 1e-8);
  EXPECT_NEAR(energy.gradient.y(), (energy_at(x + h * w) - energy_at(x - h * w)) / (2 * h), 1e-8);
}

TEST(PlanarEnergy, HasTheTrueHessianWithinTheTrianglesPlane) {
  const Vec3 x(0.05, -0.1, 0.1);
  const Vec3 normal = (kB - x).cross(kC - x).normalized();
  const Vec3 u = normal.unitOrthogonal(), w = normal.cross(u);
  PlanarEnergy energy, along_u, along_w;
  energy.add(x, kB, kC, u, w);
  const double h = 1e-6;
  along_u.add(x + h * u, kB, kC, u, w);
  along_w.add(x + h * w, kB, kC, u, w);
  EXPECT_NEAR(energy.hessian(0, 0), (along_u.gradient.x() - energy.gradient.x()) / h, 1e-4);
  EXPECT_NEAR(energy.hessian(0, 1), (along_w.gradient.x() - energy.gradient.x()) / h, 1e-4);
  EXPECT_NEAR(energy.hessian(1, 1), (along_w.gradient.y() - energy.gradient.y()) / h, 1e-4);
  EXPECT_GT(energy.hessian.determinant(), 0);
}

TEST(PlanarEnergy, IsInfiniteForADegenerateTriangle) {
  PlanarEnergy energy;
  energy.add(0.5 * (kB + kC), kB, kC, Vec3::UnitX(), Vec3::UnitY());
  EXPECT_TRUE(std::isinf(energy.value) || energy.value > 1e20);
}

}  // namespace
}  // namespace vmesh
