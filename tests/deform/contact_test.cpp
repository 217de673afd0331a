#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"

namespace vmesh::testing {
namespace {

const Material kVessel{.young_Pa = 1e6, .density_kg_m3 = 1000, .poisson_ratio = 0.3, .damping_s = 0.02};
constexpr double kVesselYoung_N_mm2 = 1;  // of kVessel

SimulationOptions dynamics(double step_s = 0.01, double drag_per_s = 0) {
  SimulationOptions options;
  options.step_s = step_s;
  options.drag_per_s = drag_per_s;
  return options;
}

InstrumentPose at(const Vec3& position) {
  InstrumentPose pose;
  pose.position_mm = position;
  return pose;
}

/// A shaft through the origin of its own frame.
InstrumentShape shaft(const Vec3& half, double radius, double friction = 0) {
  return {{Vec3(-half), half}, {radius, radius}, friction};
}

/// A chain of nodes of one radius.
Centerline chain(const std::vector<Vec3>& points, double radius) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (const Vec3& p : points) nodes.push_back({p, radius});
  for (Index i = 1; i < nodes.size(); ++i) segments.push_back({i - 1, i});
  return {nodes, segments};
}

TEST(Contact, CantileverPressedByAShaft) {
  constexpr double kLength = 80, kPressed = 4;
  CenterlineSimulation rod = simulate(straight_rod(50, 100, 1), kVessel, dynamics(0.02, 5));
  rod.clamp(0);
  // Crosswise over the rod at 80 mm, a contact of two cylinders.
  const Index shaft_number = rod.add_instrument(shaft(Vec3(0, 10, 0), 2), at(Vec3(kLength, 0, 3.1)));
  for (int i = 1; i <= 50; ++i) {
    rod.move_instrument(shaft_number, at(Vec3(kLength, 0, 3.1 - (kPressed + 0.1) * i / 50)));
    rod.step();
  }
  for (int i = 0; i < 300; ++i) rod.step();
  const HandForce hand = rod.instrument_force(shaft_number);
  const double deflection = -rod.position(40).z();
  const double force = 3 * kVesselYoung_N_mm2 * second_moment_mm4(1) * deflection / std::pow(kLength, 3);
  // Fifty straight segments are 1 % off; the rest of a deflection of a twentieth is of second order, a fifth of a
  // percent.
  EXPECT_NEAR(hand.force_N.z(), force, 0.012 * force);
  EXPECT_EQ(hand.behind_mm, 0);
  // The gap is between nothing and the reach of the barrier, a twentieth of the radius.
  EXPECT_GE(deflection, kPressed - 1e-3);
  EXPECT_LE(deflection, kPressed + 0.055);
  // What presses is carried by the inlet.
  EXPECT_NEAR(rod.drag_force(0).force_N.z(), -hand.force_N.z(), 1e-3 * force);
  EXPECT_NEAR(rod.drag_force(0).force_N.x(), -hand.force_N.x(), 1e-3 * force);
}

TEST(Contact, TorqueIsForceTimesArm) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics(0.02, 5));
  rod.clamp(0);
  // The shaft's frame is 30 mm from where it presses.
  const InstrumentShape shape{{Vec3(0, 20, 0), Vec3(0, 40, 0)}, {2, 2}, 0};
  const Index instrument = rod.add_instrument(shape, at(Vec3(60, -30, 3.1)));
  rod.move_instrument(instrument, at(Vec3(60, -30, 0)));
  for (int i = 0; i < 200; ++i) rod.step();
  const HandForce hand = rod.instrument_force(instrument);
  ASSERT_GT(hand.force_N.z(), 0);
  // The rod's surface is at y = 0 and 2 mm below the shaft's axis.
  const Vec3 torque = Vec3(0, 30, -2).cross(hand.force_N);
  EXPECT_NEAR(hand.torque_N_mm.x(), torque.x(), 1e-3 * torque.norm());
}

TEST(Contact, WhatIsHeldStopsAnInstrument) {
  CenterlineSimulation rod = simulate(straight_rod(1, 10, 1), kVessel, dynamics());
  rod.clamp(0);
  rod.clamp(1);
  const Index ball = rod.add_instrument({{Vec3::Zero()}, {1}, 0}, at(Vec3(5, 0, 4)));
  rod.move_instrument(ball, at(Vec3(5, 0, 0)));
  for (int i = 0; i < 50; ++i) rod.step();
  EXPECT_GT(rod.instrument_pose(ball).position_mm.z(), 2);
  EXPECT_LT(rod.instrument_pose(ball).position_mm.z(), 2.05);
  EXPECT_NEAR(rod.instrument_force(ball).behind_mm, rod.instrument_pose(ball).position_mm.z(), 1e-12);
}

TEST(Contact, WhatIsDraggedStopsAtAnInstrument) {
  CenterlineSimulation rod = simulate(straight_rod(10, 100, 1), kVessel, dynamics());
  rod.clamp(0);
  rod.add_instrument(shaft(Vec3(0, 30, 0), 2), at(Vec3(100, 0, 6)));
  rod.drag(10, Vec3(100, 0, 12));  // through the shaft
  for (int i = 0; i < 50; ++i) rod.step();
  EXPECT_LT(rod.position(10).z(), 3);
  EXPECT_GT(rod.position(10).z(), 2.9);
  EXPECT_GT(rod.drag_force(10).behind_mm, 8);
}

TEST(Contact, FastInstrumentsDoNotTunnel) {
  for (const double speed_mm_s : {1e2, 1e3, 1e4, 1e5}) {
    CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics());
    rod.clamp(0);
    rod.clamp(20);
    const Index ball = rod.add_instrument({{Vec3::Zero()}, {0.1}, 0}, at(Vec3(52.5, 0, 3)));
    for (int i = 1; i < 20; ++i) {
      rod.move_instrument(ball, at(Vec3(52.5, 0, std::max(-20.0, 3 - speed_mm_s * 0.01 * i))));
      rod.step();
      const Vec3 middle = 0.5 * (rod.position(10) + rod.position(11));
      ASSERT_GT(rod.instrument_pose(ball).position_mm.z(), middle.z() + 1) << speed_mm_s << ", step " << i;
    }
  }
}

/// The force that bends a rod, clamped at both ends, so that its middle gives way by this much. Its ends cannot come
/// nearer to each other, so it is stretched, which stiffens it: a beam under its own tension T, k^2 = T / (E J), with
///   way = force / (2 T k) (k L / 2 - 2 tanh(k L / 4)),   T = E A / (2 L) times the integral of the squared slope
/// (Timoshenko, Strength of Materials, part II: laterally loaded bars in tension, with built-in ends).
double press_at_middle(double way, double length, double radius) {
  const double bending = kVesselYoung_N_mm2 * second_moment_mm4(radius);
  const double stretch = kVesselYoung_N_mm2 * area_mm2(radius);
  double low = 0, high = stretch, force = 0;
  for (int i = 0; i < 100; ++i) {
    const double tension = 0.5 * (low + high), k = std::sqrt(tension / bending);
    force = way * 2 * tension * k / (k * length / 2 - 2 * std::tanh(k * length / 4));
    double squared_slope = 0;
    constexpr int kParts = 1000;
    for (int part = 0; part < kParts; ++part) {
      const double x = 0.5 * length * (part + 0.5) / kParts;
      const double slope =
          force / (2 * tension) * (1 - std::cosh(k * x) + std::tanh(k * length / 4) * std::sinh(k * x));
      squared_slope += slope * slope * length / kParts;
    }
    (stretch / (2 * length) * squared_slope > tension ? low : high) = tension;
  }
  return force;
}

struct CrossedRods {
  double lower_bends, upper_bends;  // mm
  Vec3 lower_ends, upper_ends;      // forces, N
};

/// Two rods that cross at right angles, each clamped at both ends, the upper one pushed down onto the lower by 2 mm.
CrossedRods push_across(int count, double length) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  const Index upper = static_cast<Index>(count) + 1, last = static_cast<Index>(count);
  for (Index rod = 0; rod < 2; ++rod)
    for (Index i = 0; i <= last; ++i) {
      const double along = length * (i - 0.5 * count) / count;
      nodes.push_back({rod == 0 ? Vec3(along, 0, 0) : Vec3(0, along, 2.2), 1});
      if (i > 0) segments.push_back({rod * upper + i - 1, rod * upper + i});
    }
  const Centerline pair(nodes, segments);
  CenterlineSimulation rods = simulate(pair, kVessel, dynamics(0.02, 5));
  rods.set_contact({.self = true});
  for (const Index end : {Index{0}, last, upper, upper + last}) rods.clamp(end);
  for (int i = 1; i <= 100; ++i) {
    for (const Index end : {upper, upper + last}) rods.drag(end, pair.node(end).position - Vec3(0, 0, 0.022 * i));
    rods.step();
  }
  for (int i = 0; i < 300; ++i) rods.step();
  const auto ends = [&](Index rod) {
    return Vec3(rods.drag_force(rod * upper).force_N + rods.drag_force(rod * upper + last).force_N);
  };
  return {-rods.position(last / 2).z(), rods.position(upper + last / 2).z(), ends(0), ends(1)};  // upper ends are at 0
}

TEST(Contact, TwoRodsPushedAcrossEachOther) {
  constexpr double kLength = 100;
  const CrossedRods coarse = push_across(40, kLength), fine = push_across(80, kLength);
  for (const CrossedRods& rods : {coarse, fine}) {
    // They share the way, 2 mm but for the gap.
    EXPECT_NEAR(rods.upper_bends, rods.lower_bends, 1e-3 * rods.lower_bends);
    EXPECT_NEAR(rods.lower_bends + rods.upper_bends, 2, 0.055);
    EXPECT_GT(rods.lower_bends + rods.upper_bends, 2);
    EXPECT_NEAR(rods.lower_ends.z(), -rods.upper_ends.z(), 1e-3 * rods.upper_ends.z());
  }
  const double force = press_at_middle(fine.lower_bends, kLength, 1);
  // A chain is too stiff by a share that falls with the length of its segments, 3 % here: the last one is clamped with
  // its end, so that the rod is shorter by half a segment. What is linear in that length is taken off.
  EXPECT_NEAR(-coarse.lower_ends.z(), force, 0.04 * force);
  EXPECT_NEAR(-fine.lower_ends.z(), force, 0.02 * force);
  EXPECT_NEAR(coarse.lower_ends.z() - 2 * fine.lower_ends.z(), force, 0.004 * force);
}

/// A heavy ball-ended rod lies on a plane, here a wide ball, that tilts.
double slide_of_block(double slope_deg, double friction) {
  // A short stiff rod on a ball of a thousand radii: as good as a plane.
  const Centerline block = straight_rod(4, 8, 1);
  SimulationOptions options = dynamics(2e-3);
  const double slope = slope_deg * M_PI / 180;
  options.gravity_mm_s2 = Vec3(0, 0, -9810);
  CenterlineSimulation simulation = simulate(block, kVessel, options);
  simulation.add_instrument({{Vec3::Zero()}, {1e4}, friction}, at(Vec3(4, 0, -1e4 - 1.045)));
  for (int i = 0; i < 100; ++i) simulation.step();
  simulation.set_gravity(9810 * Vec3(std::sin(slope), 0, -std::cos(slope)));
  const double start = simulation.position(2).x();
  for (int i = 0; i < 100; ++i) simulation.step();
  return simulation.position(2).x() - start;
}

TEST(Contact, BlockSlidesAboveTheAngleOfFriction) {
  constexpr double kFriction = 0.4;
  const double angle_deg = std::atan(kFriction) * 180 / M_PI;
  // Below: it creeps by at most the speed at which friction yields, a hundredth of a radius a second, and settles.
  EXPECT_LT(slide_of_block(angle_deg - 1, kFriction), 0.05);
  // Above: as far as free fall along the slope less friction, 1/2 g (sin - mu cos) t^2.
  const auto expected = [&](double degrees) {
    const double a = degrees * M_PI / 180;
    return 0.5 * 9810 * (std::sin(a) - kFriction * std::cos(a)) * 0.2 * 0.2;
  };
  EXPECT_NEAR(slide_of_block(angle_deg + 10, kFriction), expected(angle_deg + 10), 0.05 * expected(angle_deg + 10));
  EXPECT_NEAR(slide_of_block(30, 0), 0.5 * 9810 * 0.5 * 0.04, 0.02 * 0.5 * 9810 * 0.5 * 0.04);
}

/// A rope over a shaft, half a turn around, pulled at one end while a force holds the other.
double capstan_ratio(double friction) {
  constexpr double kShaft = 10, kRope = 0.2;
  const double around = kShaft + 1.04 * kRope;
  std::vector<Vec3> points;
  for (int i = 0; i < 20; ++i) points.emplace_back(-around, 0, -20.0 + i);
  for (int i = 0; i <= 64; ++i) {
    const double angle = M_PI * (1 - i / 64.0);
    points.emplace_back(around * std::cos(angle), 0, around * std::sin(angle));
  }
  for (int i = 1; i <= 20; ++i) points.emplace_back(around, 0, -i);
  CenterlineSimulation rope =
      simulate(chain(points, kRope), {.young_Pa = 1e6, .poisson_ratio = 0.3, .damping_s = 0.02}, dynamics(5e-3, 20));
  const Index last = static_cast<Index>(points.size() - 1);
  rope.add_instrument(shaft(Vec3(0, 5, 0), kShaft, friction), at(Vec3::Zero()));
  // Well below what stretches it, well above what bends it: E J / R^2 is 1e-5 N.
  constexpr double kHold = 2e-3;
  rope.set_force(0, Vec3(0, 0, -kHold));
  rope.set_force(last, Vec3(0, 0, -kHold));
  for (int i = 0; i < 100; ++i) rope.step();
  rope.set_force(last, Vec3::Zero());
  const Vec3 from = rope.position(last);
  double sum = 0;
  for (int i = 1; i <= 400; ++i) {
    rope.drag(last, from - Vec3(0, 0, 0.02 * i));
    rope.step();
    if (i > 300) sum += rope.drag_force(last).force_N.z() / 100;
  }
  return sum / kHold;
}

TEST(Contact, RopeAroundAShaftIsACapstan) {
  EXPECT_NEAR(capstan_ratio(0), 1, 0.05);
  EXPECT_NEAR(capstan_ratio(0.3), std::exp(0.3 * M_PI), 0.05 * std::exp(0.3 * M_PI));
}

TEST(Contact, JawsHoldAnyPlaceAndFeelIt) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics(0.02, 5));
  rod.clamp(0);
  const Index jaw = rod.grasp(15, 0.4);  // at 77 mm
  for (int i = 1; i <= 50; ++i) {
    rod.move_jaw(jaw, Vec3(77, 0, 0.001 * i));
    rod.step();
  }
  for (int i = 0; i < 200; ++i) rod.step();
  const Vec3 held = 0.6 * rod.position(15) + 0.4 * rod.position(16);
  const double force = 3 * kVesselYoung_N_mm2 * second_moment_mm4(1) * 0.05 / std::pow(77, 3);
  // Jaws are a hundred times stiffer than the segment, which is thousands of times stiffer than what it bends.
  EXPECT_LT((held - Vec3(77, 0, 0.05)).norm(), 1e-6);
  // Twenty segments are 3 % off.
  EXPECT_NEAR(rod.jaw_force(jaw).force_N.z(), -force, 0.04 * force);
  rod.open_jaw(jaw);
  for (int i = 0; i < 300; ++i) rod.step();
  EXPECT_EQ(rod.jaw_force(jaw).force_N, Vec3::Zero());
  EXPECT_FALSE(rod.jaw_force(jaw).holds);
}

TEST(Contact, JawsSlipAboveTheirForceUntilTheyLoseTheVessel) {
  constexpr double kSlips = 0.01;
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics(0.02, 5));
  rod.clamp(0);
  const Index jaw = rod.grasp(17, 0.5, kSlips);
  // Without slipping, 3 mm would need 3 E A / L = 0.1 N.
  double most = 0;
  for (int i = 1; i <= 200; ++i) {
    rod.move_jaw(jaw, Vec3(87.5 + 0.015 * i, 0, 0));
    rod.step();
    most = std::max(most, rod.jaw_force(jaw).force_N.norm());
  }
  EXPECT_TRUE(rod.jaw_force(jaw).holds);
  EXPECT_NEAR(rod.jaw_force(jaw).force_N.norm(), kSlips, 1e-6);
  EXPECT_LE(most, kSlips * (1 + 1e-9));
  for (int i = 1; i <= 200; ++i) {
    rod.move_jaw(jaw, Vec3(90.5 + 0.1 * i, 0, 0));
    rod.step();
  }
  EXPECT_FALSE(rod.jaw_force(jaw).holds);
}

/// A rod on an elastic foundation, pushed down at its middle: w(x) = P b / (2 k) exp(-b x) (cos b x + sin b x),
/// b^4 = k / (4 E J).
TEST(Contact, TissueIsAnElasticFoundation) {
  CenterlineSimulation rod = simulate(straight_rod(200, 100, 1), kVessel, dynamics(0.05, 5));
  constexpr double kFoundation = 1e-3;  // N / mm^2
  for (Index s = 0; s < 200; ++s) rod.set_tissue(s, {kFoundation});
  const double push = 1e-4;
  rod.set_force(100, Vec3(0, 0, -push));
  for (int i = 0; i < 400; ++i) rod.step();
  const double b = std::pow(kFoundation / (4 * kVesselYoung_N_mm2 * second_moment_mm4(1)), 0.25);
  for (const Index node : {100, 104, 110}) {
    const double x = 0.5 * (node - 100);
    const double w = push * b / (2 * kFoundation) * std::exp(-b * x) * (std::cos(b * x) + std::sin(b * x));
    EXPECT_NEAR(-rod.position(node).z(), w, 0.02 * push * b / (2 * kFoundation)) << node;
  }
  EXPECT_EQ(rod.torn(), 0);
}

TEST(Contact, TissueTearsWherePulledHardest) {
  CenterlineSimulation rod = simulate(straight_rod(50, 100, 1), kVessel, dynamics(0.02, 5));
  for (Index s = 0; s < 50; ++s) rod.set_tissue(s, {1e-3, 2e-3});  // at 2 mm
  for (int i = 1; i <= 200; ++i) {
    rod.drag(50, Vec3(100, 0, 0.05 * i));
    rod.step();
    for (Index n = 0; n < 50; ++n)
      if (rod.position(n).z() < 1.5) {
        // What still holds is within what it can be pulled.
        ASSERT_LE((rod.position(n) - Vec3(2.0 * n, 0, 0)).norm(), 10);
      }
  }
  EXPECT_GT(rod.torn(), 1);
  EXPECT_LT(rod.torn(), 45);
  EXPECT_LT(rod.position(5).norm() - 10, 0.5);  // the other end has not moved
}

/// A rod passes the side of a much thicker one at a hundredth of its radius, by a hundred times that way in a step: it
/// goes on as fast, and the barrier pushes it aside at no more than a twentieth of its speed.
TEST(Contact, WhatSlidesPastCloselyIsNotHeldUp) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i <= 4; ++i) nodes.push_back({Vec3(0, 0, 10.0 * i - 20), 5});
  for (Index i = 0; i <= 4; ++i) nodes.push_back({Vec3(2.0 * i - 30, 6.01, 0), 1});
  for (const Index first : {0, 5})
    for (Index i = 0; i < 4; ++i) segments.push_back({first + i, first + i + 1});
  const Centerline pair(nodes, segments);
  CenterlineSimulation rods = simulate(pair, kVessel, dynamics());
  rods.set_contact({.self = true});
  for (Index node = 0; node <= 4; ++node) rods.clamp(node);
  constexpr double kSpeed_mm_s = 100;
  for (Index node = 5; node <= 9; ++node) rods.set_velocity(node, Vec3(kSpeed_mm_s, 0, 0));
  for (int i = 0; i < 50; ++i) rods.step();
  EXPECT_NEAR(rods.position(7).x(), -26 + kSpeed_mm_s * 0.5, 0.02 * kSpeed_mm_s * 0.5);
  EXPECT_NEAR(rods.position(7).y(), 6.01, 0.05 * kSpeed_mm_s * 0.5);  // pushed off by the barrier, slowly
  EXPECT_GT(rods.position(7).y(), 6);
}

/// A tree so soft that its branches fall onto each other, many at a time, by many radii in a step: it comes to hang
/// from its root, all of its weight, and does not remain where something was in the way.
TEST(Contact, SoftTreeFallsIntoAHeapThatHangsFromItsRoot) {
  const Centerline tree = synthetic_tree({.vertices = 119, .seed = 1});
  SimulationOptions options = dynamics(0.02);
  options.gravity_mm_s2 = Vec3(0, 0, -9810);
  const std::vector<SegmentProperties> properties = segment_properties(tree, {.young_Pa = 1e3});
  CenterlineSimulation simulation(tree, properties, options);
  simulation.clamp(0);
  simulation.set_contact({.self = true});
  double work_J = 0;
  for (int i = 0; i < 100; ++i) {
    work_J += simulation.step().work_J;
    ASSERT_GT(simulation.smallest_gap_mm(), 0) << i;
    ASSERT_LE(energy_J(simulation) + simulation.contact_energy_J(), work_J + 1e-9 * std::abs(work_J)) << i;
  }
  double weight_N = 0;
  for (const SegmentProperties& p : properties) weight_N += 9.81 * p.mass_kg;
  // It still swings a little.
  EXPECT_NEAR(-simulation.drag_force(0).force_N.z(), weight_N, 0.03 * weight_N);
}

/// Moves an instrument straight to a place in 50 steps, and waits until everything is at rest.
void press(CenterlineSimulation& rod, Index instrument, const Vec3& to) {
  const Vec3 from = rod.instrument_pose(instrument).position_mm;
  for (int i = 1; i <= 50; ++i) {
    rod.move_instrument(instrument, at(from + i / 50.0 * (to - from)));
    rod.step();
  }
  for (int i = 0; i < 400; ++i) rod.step();
}

TEST(Contact, WhatAnInstrumentPressedReturnsWhenItIsRemoved) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics(0.02, 5));
  rod.clamp(0);
  const Index ball = rod.add_instrument({{Vec3::Zero()}, {2}, 0.2}, at(Vec3(80, 0, 3.1)));
  press(rod, ball, Vec3(80, 0, -1));
  ASSERT_LT(rod.position(20).z(), -4);
  rod.remove_instrument(ball);
  for (int i = 0; i < 1000; ++i) rod.step();
  // At rest when it moves by less than 1e-7 radii in a step, for ten of them.
  EXPECT_NEAR(rod.position(20).z(), 0, 1e-3);
  EXPECT_THROW(rod.move_instrument(ball, at(Vec3(80, 0, 3.1))), InvalidInput);
  EXPECT_THROW(rod.instrument_force(ball), InvalidInput);
  EXPECT_THROW(rod.remove_instrument(ball), InvalidInput);
}

TEST(Contact, TheOthersPressOnWhenOneIsRemoved) {
  const InstrumentShape across = shaft(Vec3(0, 10, 0), 2, 0.1);
  const auto pressed = [&](bool among_others) {
    CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics(0.02, 5));
    rod.clamp(0);
    const Vec3 above(80, 0, 3.1), beside(30, 0, 3.1);
    const Index first = among_others ? rod.add_instrument(across, at(beside)) : kNone;
    const Index pressing =
        rod.add_instrument({{Vec3(0, -9, 0), Vec3(0, 0, 0), Vec3(0, 9, 0)}, {2, 2, 2}, 0}, at(above));
    const Index last = among_others ? rod.add_instrument(across, at(Vec3(60, 0, 3.05))) : kNone;
    if (among_others) press(rod, first, beside - Vec3(0, 0, 0.3));
    press(rod, pressing, Vec3(80, 0, 0));
    if (among_others) {
      rod.remove_instrument(first);
      EXPECT_GT(rod.instrument_force(pressing).force_N.z(), 0);
      rod.remove_instrument(last);
    }
    for (int i = 0; i < 1000; ++i) rod.step();
    return rod.instrument_force(pressing).force_N.z();
  };
  const double alone = pressed(false);
  ASSERT_GT(alone, 0);
  EXPECT_NEAR(pressed(true), alone, 1e-3 * alone);
}

TEST(Contact, OneThatIsAddedDoesNotHoldUpAnother) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics());
  rod.clamp(0);
  const Index ball = rod.add_instrument({{Vec3::Zero()}, {2}, 0}, at(Vec3(80, 0, 3.1)));
  rod.move_instrument(ball, at(Vec3(80, 0, 2.5)));
  rod.add_instrument({{Vec3::Zero()}, {2}, 0}, at(Vec3(20, 0, 10)));
  rod.step();
  EXPECT_EQ(rod.instrument_pose(ball).position_mm, Vec3(80, 0, 2.5));
}

TEST(Contact, AroundVesselsAtRestInstrumentsGoTheWayTheyAreMoved) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics());
  rod.clamp(0);
  const Index ball = rod.add_instrument({{Vec3::Zero()}, {1}, 0}, at(Vec3(50, 0, 10)));
  for (int i = 0; i < 50; ++i) rod.step();  // to rest
  // Around the rod; straight from the first to the last it would be in the way.
  for (const Vec3& to : {Vec3(50, 10, 10), Vec3(50, 10, -10), Vec3(50, 0, -10)}) {
    rod.move_instrument(ball, at(to));
    rod.step();
    EXPECT_EQ(rod.instrument_pose(ball).position_mm, to);
  }
  EXPECT_EQ(rod.position(20), Vec3(100, 0, 0));
}

TEST(Contact, RoomForAnInstrumentIsItsGap) {
  CenterlineSimulation rod = simulate(straight_rod(20, 100, 1), kVessel, dynamics());
  const InstrumentShape across = shaft(Vec3(0, 10, 0), 2);
  EXPECT_NEAR(rod.room_for_instrument_mm(across, at(Vec3(50, 0, 5))), 2, 1e-9);
  EXPECT_NEAR(rod.room_for_instrument_mm({{Vec3::Zero()}, {2}, 0}, at(Vec3(103, 0, 4))), 2, 1e-9);
  const InstrumentPose within = at(Vec3(50, 0, 2.5)), beside = at(Vec3(50, 0, 3.001));
  EXPECT_LT(rod.room_for_instrument_mm(across, within), 0);
  EXPECT_THROW(rod.add_instrument(across, within), InvalidInput);
  EXPECT_GT(rod.room_for_instrument_mm(across, beside), 0);
  EXPECT_NO_THROW(rod.add_instrument(across, beside));
  // Asked again, beside what there is now: of vessels only.
  EXPECT_NEAR(rod.room_for_instrument_mm(across, at(Vec3(50, 0, 5))), 2, 1e-9);
}

TEST(Contact, RefusesWhatMakesNoSense) {
  CenterlineSimulation rod = simulate(straight_rod(4, 10, 1), kVessel, dynamics());
  EXPECT_THROW(rod.add_instrument({{Vec3::Zero()}, {1}, 0}, at(Vec3(5, 0, 1.5))), InvalidInput);  // within the rod
  EXPECT_THROW(rod.add_instrument({{}, {}, 0}, at(Vec3(5, 0, 9))), InvalidInput);
  EXPECT_THROW(rod.add_instrument({{Vec3::Zero()}, {0}, 0}, at(Vec3(5, 0, 9))), InvalidInput);
  EXPECT_THROW(rod.add_instrument({{Vec3::Zero()}, {1, 2}, 0}, at(Vec3(5, 0, 9))), InvalidInput);
  EXPECT_THROW(rod.move_instrument(0, at(Vec3::Zero())), InvalidInput);
  EXPECT_THROW(rod.remove_instrument(0), InvalidInput);
  EXPECT_THROW(rod.grasp(4, 0), InvalidInput);
  EXPECT_THROW(rod.grasp(3, 1.5), InvalidInput);
  EXPECT_THROW(rod.set_tissue(0, {-1}), InvalidInput);
  EXPECT_THROW(rod.set_contact({.gap_ratio = 0}), InvalidInput);
  SimulationOptions paper;
  paper.integrator = Integrator::paper;
  CenterlineSimulation old = simulate(straight_rod(4, 10, 1), kVessel, paper);
  EXPECT_THROW(old.set_contact({}), InvalidInput);
}

}  // namespace
}  // namespace vmesh::testing
