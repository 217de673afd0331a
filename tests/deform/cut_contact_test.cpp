// Cuts while vessels are touched, held and buried.
#include <gtest/gtest.h>

#include "vmesh/centerline/cut.h"

#include "chains.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

const Material kTissueVessel{.young_Pa = 1e5, .density_kg_m3 = 1000, .poisson_ratio = 0.3, .damping_s = 0.02};

SimulationOptions hundredths() {
  SimulationOptions options;
  options.step_s = 0.01;
  options.drag_per_s = 2;
  return options;
}

InstrumentPose placed(const Vec3& position) {
  InstrumentPose pose;
  pose.position_mm = position;
  return pose;
}

TEST(CutAmong, AShaftThatPressesGoesOn) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kTissueVessel, hundredths());
  rod.clamp(0);
  rod.clamp(20);
  const Index shaft = rod.add_instrument({{Vec3(0, -10, 0), Vec3(0, 10, 0)}, {2, 2}, 0}, placed(Vec3(30, 0, 3.2)));
  for (int i = 1; i <= 50; ++i) {
    rod.move_instrument(shaft, placed(Vec3(30, 0, 3.2 - 5.0 * i / 50)));
    rod.step();
  }
  for (int i = 0; i < 100; ++i) rod.step();
  const double pressed = rod.instrument_force(shaft).force_N.z();
  EXPECT_GT(pressed, 0);
  rod.cut(cut_centerline(straight_rod(20, 100, 1), {12, 0.5}));
  EXPECT_LT((rod.instrument_pose(shaft).position_mm - Vec3(30, 0, -1.8)).norm(), 1e-12);
  for (int i = 0; i < 300; ++i) {
    rod.step();
    ASSERT_GT(rod.smallest_gap_mm(), 0);
  }
  // Held at one end instead of two, the rod gives way.
  const double after = rod.instrument_force(shaft).force_N.z();
  EXPECT_GT(after, 0);
  EXPECT_LT(after, 0.9 * pressed);
  EXPECT_LT(rod.position(6).z(), -3);
}

TEST(CutAmong, JawsKeepThePartThatTheyHold) {
  const Centerline centerline = straight_rod(20, 100, 1);
  CenterlineSimulation rod = simulate(centerline, kTissueVessel, hundredths());
  rod.clamp(0);
  const Index first = rod.grasp(8, 0.75), second = rod.grasp(8, 0.25);
  rod.step();
  const CenterlineCut cut = cut_centerline(centerline, {8, 0.5});
  rod.cut(cut);
  for (int i = 1; i <= 100; ++i) {
    rod.move_jaw(first, Vec3(43.75, 0, 0.2 * i));
    rod.step();
  }
  for (int i = 0; i < 100; ++i) rod.step();
  EXPECT_LT((rod.jaw_position(first) - Vec3(43.75, 0, 20)).norm(), 1e-9);
  // Jaws hold three quarters along the segment that was cut: half along the new one.
  const Vec3 held = (rod.position(cut.end[1]) + rod.position(9)) / 2;
  EXPECT_LT((held - rod.jaw_position(first)).norm(), 0.05);
  EXPECT_LT((rod.position(cut.end[0]) - Vec3(42.5, 0, 0)).norm(), 0.05);
  EXPECT_LT((rod.jaw_position(second) - Vec3(41.25, 0, 0)).norm(), 1e-9);
}

TEST(CutAmong, TissueHoldsBothPartsAndStaysTorn) {
  const Centerline centerline = straight_rod(20, 100, 1);
  CenterlineSimulation rod = simulate(centerline, kTissueVessel, hundredths());
  for (Index s = 0; s < 20; ++s) rod.set_tissue(s, {.stiffness_N_mm2 = 1e-4, .tear_N_mm = 3e-4});
  rod.drag(20, Vec3(100, 0, 8));
  for (int i = 0; i < 100; ++i) rod.step();
  const std::size_t torn = rod.torn();
  EXPECT_GT(torn, 0);
  rod.release(20);
  const CenterlineCut cut = cut_centerline(centerline, {10, 0.5});
  rod.cut(cut);
  EXPECT_EQ(rod.torn(), torn);
  for (int i = 0; i < 500; ++i) rod.step();
  EXPECT_EQ(rod.torn(), torn);
  for (Index n = 0; n <= 10; ++n) EXPECT_LT((rod.position(n) - centerline.node(n).position).norm(), 0.05) << n;
  EXPECT_LT((rod.position(cut.end[0]) - rod.position(cut.end[1])).norm(), 0.05);
}

/// A rod in waves, whose parts fall on each other once it is cut.
Centerline waves() {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i <= 40; ++i) {
    const double angle = 0.35 * i;
    nodes.push_back({Vec3(2.0 * i, 12 * std::sin(angle), 8 * std::cos(angle)), 1.2});
    if (i > 0) segments.push_back({static_cast<Index>(i - 1), static_cast<Index>(i)});
  }
  return {std::move(nodes), std::move(segments)};
}

TEST(CutAmong, PartsThatFallOnEachOtherNeverOverlap) {
  for (std::uint32_t seed = 1; seed < 6; ++seed) {
    Draw draw(seed);
    Centerline centerline = waves();
    CenterlineSimulation rod = simulate(centerline, kTissueVessel, hundredths());
    rod.set_contact({.self = true, .friction = 0.2});
    rod.clamp(0);
    rod.clamp(40);
    rod.set_gravity(Vec3(0, 0, -9810));
    for (int i = 0; i < 240; ++i) {
      if (i % 40 == 20) {
        const auto segments = static_cast<Index>(centerline.segments().size());
        const CenterlineCut cut = cut_centerline(centerline, {draw.below(segments), draw.uniform(0.1, 0.9)});
        rod.cut(cut);
        centerline = cut.centerline;
      }
      const double energy = energy_J(rod) + rod.contact_energy_J();
      const StepReport report = rod.step();
      ASSERT_GT(rod.smallest_gap_mm(), 0) << seed << " " << i;
      ASSERT_TRUE(std::isfinite(energy));
      ASSERT_LE(energy_J(rod) + rod.contact_energy_J(), energy + report.work_J + 1e-9 * (energy + report.work_J));
    }
  }
}

}  // namespace
}  // namespace vmesh::testing
