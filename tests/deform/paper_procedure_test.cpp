// The paper's procedure against the default.
#include <gtest/gtest.h>

#include "chains.h"

namespace vmesh::testing {
namespace {

/// So soft that explicit springs need few substeps.
constexpr Material kSoft{.young_Pa = 1e5, .density_kg_m3 = 1000, .poisson_ratio = 0};

constexpr int kSegments = 10;
constexpr double kLength = 50;

/// A rod held at one end, at rest under a load.
Vec3 tip_at_rest(Integrator integrator, const PaperProcedure& paper, const Material& material,
                 const Vec3& gravity_mm_s2, const Vec3& force_N) {
  SimulationOptions options;
  options.integrator = integrator;
  options.paper = paper;
  options.gravity_mm_s2 = gravity_mm_s2;
  options.drag_per_s = 14;
  options.step_s = 0.01;
  CenterlineSimulation rod = simulate(straight_rod(kSegments, kLength, 1), material, options);
  rod.clamp(0);
  rod.set_force(kSegments, force_N);
  for (int i = 0; i < 300; ++i) rod.step();
  return rod.position(kSegments);
}

constexpr PaperProcedure kPrinted{};
constexpr PaperProcedure kSpringPolar{PaperProcedure::Coupling::spring, PaperProcedure::Axes::polar, 0};
constexpr PaperProcedure kSpringPrintedAxes{PaperProcedure::Coupling::spring, PaperProcedure::Axes::printed, 0};

TEST(PaperProcedure, AgreesWithTheDefaultOnPureStretch) {
  const Vec3 pull(0.01, 0, 0);
  const double expected = tip_at_rest(Integrator::implicit, {}, kSoft, Vec3::Zero(), pull).x();
  EXPECT_NEAR(expected - kLength, 0.01 * kLength / (0.1 * area_mm2(1)), 1e-6);
  for (const PaperProcedure& procedure : {kPrinted, kSpringPolar, kSpringPrintedAxes})
    EXPECT_NEAR(tip_at_rest(Integrator::paper, procedure, kSoft, Vec3::Zero(), pull).x(), expected,
                1e-3 * (expected - kLength));
}

TEST(PaperProcedure, WithPolarAxesAgreesWithTheDefaultOnSag) {
  const Vec3 gravity(0, 0, -100);
  const double expected = tip_at_rest(Integrator::implicit, {}, kSoft, gravity, Vec3::Zero()).z();
  const double polar = tip_at_rest(Integrator::paper, kSpringPolar, kSoft, gravity, Vec3::Zero()).z();
  const double keeping_z = tip_at_rest(Integrator::paper, kSpringPrintedAxes, kSoft, gravity, Vec3::Zero()).z();
  const double printed = tip_at_rest(Integrator::paper, kPrinted, kSoft, gravity, Vec3::Zero()).z();
  EXPECT_LT(expected, -2);
  EXPECT_NEAR(polar, expected, 1e-4 * std::abs(expected));
  // Eqs. 6 and 7 lose the springs of x and y about the transverse axes: half of the stiffness against bending where all
  // three springs are equal.
  EXPECT_NEAR(keeping_z / expected, 2, 0.05);
  // Eq. 8 as printed moves a segment's end with no reaction on its beginning, so no weight is passed on.
  EXPECT_LT(printed / expected, 0.1);
}

}  // namespace
}  // namespace vmesh::testing
