#include <gtest/gtest.h>

#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "deform/rod_scene.h"

namespace vmesh::testing {
namespace {

constexpr double kLength = 100, kRadius = 1;
const Material kSoft{.young_Pa = 1e6, .density_kg_m3 = 1000, .poisson_ratio = 0.3};
constexpr double kYoung_N_mm2 = 1;  // of kSoft

/// A torque acts on the frame as of the start of the step, so large rotations need more than one step.
void settle(CenterlineSimulation& rod) {
  for (int i = 0; i < 10; ++i) rod.step();
}

/// Sag of the tip of a horizontal rod held at one end, over what beam theory says: q L^4 / (8 E J).
double relative_sag(int segments) {
  SimulationOptions options = statics();
  options.gravity_mm_s2 = Vec3(0, 0, -1);  // a ten-thousandth of the earth's: a sag of 0.5 % of the length
  CenterlineSimulation rod = simulate(straight_rod(segments, kLength, kRadius), kSoft, options);
  rod.clamp(0);
  rod.step();
  const double weight_N_mm = 1e-6 * area_mm2(kRadius) * 1e-3;
  const double sag = weight_N_mm * std::pow(kLength, 4) / (8 * kYoung_N_mm2 * second_moment_mm4(kRadius));
  return -rod.position(static_cast<Index>(segments)).z() / sag;
}

TEST(Physics, SagOfACantileverConvergesToBeamTheory) {
  double last = 1;
  for (const int segments : {5, 10, 20, 40, 80}) {
    const double error = std::abs(relative_sag(segments) - 1);
    EXPECT_LT(error, last) << segments;
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

TEST(Physics, PureStretchIsForceOverStiffness) {
  for (const int segments : {1, 7, 40}) {
    CenterlineSimulation rod = simulate(straight_rod(segments, kLength, kRadius), kSoft, statics());
    const Index tip = static_cast<Index>(segments);
    rod.clamp(0);
    rod.set_force(tip, Vec3(0.01, 0, 0));
    rod.step();
    const double stretch = 0.01 * kLength / (kYoung_N_mm2 * area_mm2(kRadius));
    EXPECT_NEAR(rod.position(tip).x() - kLength, stretch, 1e-6 * stretch) << segments;
  }
}

TEST(Physics, TwistIsTorqueOverTorsionalStiffness) {
  for (const int segments : {10, 40, 100}) {
    CenterlineSimulation rod = simulate(straight_rod(segments, kLength, kRadius), kSoft, statics());
    const Index tip = static_cast<Index>(segments);
    rod.clamp(0);
    rod.set_torque(tip, Vec3(1e-3, 0, 0));
    settle(rod);
    const double shear_N_mm2 = kYoung_N_mm2 / (2 * (1 + kSoft.poisson_ratio));
    // The last frame is that of the middle of the last segment.
    const double length = kLength * (1 - 0.5 / segments);
    const double twist = 1e-3 * length / (shear_N_mm2 * 2 * second_moment_mm4(kRadius));
    const Mat3 turn = rod.pose().frame[tip] * rod.tree().frame[tip].transpose();
    // sin x instead of x at every joint: an error of a sixth of the square of a joint's twist, 0.016 at most.
    EXPECT_NEAR(std::atan2(turn(2, 1), turn(1, 1)), twist, 1e-4 * twist) << segments;
  }
}

TEST(Physics, EndMomentBendsIntoAnArc) {
  // A full half turn: far beyond small deflections.
  constexpr int kSegments = 60;
  CenterlineSimulation rod = simulate(straight_rod(kSegments, kLength, kRadius), kSoft, statics());
  rod.clamp(0);
  const double curvature = std::numbers::pi / kLength;
  for (int i = 1; i <= 20; ++i) {
    rod.set_torque(kSegments, Vec3(0, 0, i / 20.0 * curvature * kYoung_N_mm2 * second_moment_mm4(kRadius)));
    rod.step();
  }
  settle(rod);
  const Vec3 tip = rod.position(kSegments);
  EXPECT_NEAR(tip.x(), 0, 0.005 * kLength);
  EXPECT_NEAR(tip.y(), 2 / curvature, 0.005 * kLength);
  EXPECT_NEAR(tip.z(), 0, 1e-6 * kLength);
}

TEST(Physics, RigidMotionMakesNoForce) {
  const Centerline tree = synthetic_tree({.vertices = 119, .seed = 1});
  RodScene scene = make_rod_scene(tree, segment_properties(tree, {}), {});
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (Vec3& p : scene.pose.position) p = turn * p + Vec3(30, -20, 10);
  for (Mat3& frame : scene.pose.frame) frame = turn * frame;
  // The springs are zero-length: no energy, no force. One bent by a thousandth would hold this much.
  const double bent = 1e-6 * scene.rods[1].tip_z;
  EXPECT_LT(elastic_energy(scene), 1e-12 * bent);
}

TEST(Physics, WhatIsThrownAsAWholeFliesAsAWhole) {
  const Centerline tree = synthetic_tree({.vertices = 119, .seed = 1});
  CenterlineSimulation simulation = simulate(tree, {}, {});
  for (Index n = 0; n < 119; ++n) simulation.set_velocity(n, Vec3(30, -20, 10));
  for (int i = 0; i < 50; ++i) simulation.step();
  for (Index n = 0; n < 119; ++n)
    EXPECT_LT((simulation.position(n) - tree.node(n).position - Vec3(30, -20, 10)).norm(), 1e-6);
  EXPECT_LT(simulation.elastic_energy_J(), 1e-12 * simulation.kinetic_energy_J());
}

}  // namespace
}  // namespace vmesh::testing
