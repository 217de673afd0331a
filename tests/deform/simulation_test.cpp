#include "vmesh/deform/simulation.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "deform/implicit_rods.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

constexpr Material kSoftRod{.young_Pa = 1e6, .density_kg_m3 = 1000, .poisson_ratio = 0};

Centerline tree_of(std::size_t vertices) {
  SyntheticTreeOptions shape;
  shape.vertices = vertices;
  return synthetic_tree(shape);
}

Centerline ring_of(int nodes, double radius) {
  std::vector<CenterlineNode> points;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < static_cast<Index>(nodes); ++i) {
    const double angle = 2 * std::numbers::pi * i / nodes;
    points.push_back({radius * Vec3(std::cos(angle), std::sin(angle), 0), 1});
    segments.push_back({i, (i + 1) % static_cast<Index>(nodes)});
  }
  return {points, segments};
}

TEST(Simulation, WhatRestsCostsNothingAndWakes) {
  const Centerline tree = tree_of(119);
  CenterlineSimulation simulation = simulate(tree, {.young_Pa = 1e8, .damping_s = 0.1}, {});
  simulation.clamp(0);
  int steps = 0;
  while (simulation.step().awake > 0) ASSERT_LT(++steps, 100);
  const Pose rest = simulation.pose();
  EXPECT_EQ(simulation.step().iterations, 0);
  simulation.set_force(118, Vec3(1e-3, 0, 0));
  EXPECT_GT(simulation.step().awake, 0u);
  EXPECT_GT((simulation.position(118) - tree.node(118).position).norm(), 1e-4);
}

TEST(Simulation, RestingPartsChangeTheMotionByLittle) {
  const Centerline tree = tree_of(200);
  SimulationOptions resting, restless;
  resting.rest_tolerance = 1e-6;
  restless.rest_tolerance = 0;
  std::vector<CenterlineSimulation> both;
  for (const SimulationOptions& options : {resting, restless}) {
    both.push_back(simulate(tree, {.young_Pa = 1e8}, options));
    both.back().clamp(0);
    for (int i = 0; i < 20; ++i) both.back().step();
  }
  std::size_t most_awake = 0;
  for (int i = 0; i < 100; ++i)
    for (CenterlineSimulation& simulation : both) {
      simulation.set_force(199, Vec3(0, 1e-4 * std::sin(0.2 * i), 0));
      const StepReport report = simulation.step();
      if (&simulation == &both[0]) most_awake = std::max(most_awake, report.awake);
    }
  EXPECT_LT(most_awake, 100u) << "half of the tree is to stay at rest";
  EXPECT_GT((both[1].position(199) - tree.node(199).position).norm(), 1e-3);
  for (Index n = 0; n < 200; ++n)
    // A hundred steps with a tolerance of a millionth of a radius each.
    EXPECT_LT((both[0].position(n) - both[1].position(n)).norm(), 1e-4 * tree.node(n).radius) << n;
}

TEST(Simulation, LoopsStayClosed) {
  const Centerline ring = ring_of(24, 20);
  SimulationOptions options;
  options.iterations = 5;
  CenterlineSimulation simulation = simulate(ring, kSoftRod, options);
  ASSERT_EQ(simulation.tree().ties.size(), 1u);
  simulation.fix(0);
  simulation.set_gravity(Vec3(0, -9810, 0));
  for (int i = 0; i < 200; ++i) {
    simulation.step();
    const auto& [slot, node_slot] = simulation.tree().ties[0];
    ASSERT_LT((simulation.pose().position[slot] - simulation.pose().position[node_slot]).norm(), 0.01) << i;
  }
  EXPECT_LT(simulation.position(12).y(), -5) << "it hangs";
}

TEST(Simulation, SameBytesAgain) {
  const Centerline tree = tree_of(119);
  const auto play = [&] {
    SimulationOptions options;
    options.gravity_mm_s2 = Vec3(0, 0, -9810);
    CenterlineSimulation simulation = simulate(tree, {}, options);
    simulation.clamp(0);
    for (int i = 0; i < 50; ++i) simulation.step();
    return simulation.pose().position;
  };
  EXPECT_EQ(play(), play());
}

/// A tree of all sorts, held, dragged and pushed, some of it at rest.
Pose played(const Centerline& vessels, const SimulationOptions& options, InstructionSet set) {
  RodScene scene = make_rod_scene(vessels, segment_properties(vessels, {.young_Pa = 1e7}), options);
  ImplicitRods rods(scene, set);
  const Index last = static_cast<Index>(scene.size() - 1);
  scene.hold[0] = Hold::clamped;
  scene.hold[last] = Hold::fixed;
  for (int i = 0; i < 60; ++i) {
    if (i >= 20) scene.target[last] += Vec3(0, 0.1 * std::sin(0.3 * i), 0.05), rods.wake(last);
    if (i == 40) scene.force[last / 2] = Vec3(1, 2, 3), rods.wake(last / 2);
    if (i == 50) scene.hold[last / 3] = Hold::fixed, scene.target[last / 3] = scene.pose.position[last / 3];
    rods.step(scene);
  }
  return scene.pose;
}

TEST(Simulation, SameBytesOnEveryMachine) {
  SimulationOptions options;
  options.rest_tolerance = 1e-5;
  for (const Centerline& vessels : {tree_of(300), ring_of(24, 20), straight_rod(30, 100, 2)}) {
    const Pose plain = played(vessels, options, InstructionSet::plain);
    const Pose best = played(vessels, options, best_instruction_set());
    EXPECT_EQ(plain.position, best.position);
    EXPECT_EQ(plain.frame, best.frame);
    EXPECT_NE(plain.position, make_rod_tree(vessels).position);
  }
}

TEST(Simulation, ConvergesWhereATreeIsWorkedOnInParts) {
  const Centerline tree = tree_of(5000);
  SimulationOptions options;
  options.iterations = 12;
  options.gravity_mm_s2 = Vec3(0, 0, -9810);
  CenterlineSimulation simulation = simulate(tree, {}, options);
  simulation.clamp(0);
  for (int i = 0; i < 3; ++i) {
    const StepReport report = simulation.step();
    // Each iteration is an exact solution: it ends at rounding, of coordinates of 100 mm and springs of like stiffness.
    EXPECT_LT(report.movement_mm, 1e-9) << i;
  }
}

TEST(Simulation, SqueezedTubeNarrowsByLaplacesLaw) {
  const Material wall{.young_Pa = 1e6, .wall_ratio = 0.1};
  CenterlineSimulation tube = simulate(straight_rod(10, 100, 5), wall, {});
  EXPECT_TRUE(tube.pose().radial_scale.empty()) << "free when off";
  const double force_N = 0.1;
  tube.set_squeeze(5, force_N);
  for (int i = 0; i < 200; ++i) tube.step();
  const double pressure_N_mm2 = force_N / (2 * std::numbers::pi * 5 * 10);
  const double strain = pressure_N_mm2 * 5 / (1.0 * 0.5);  // p r / (E t)
  const Index slot = tube.tree().slot_of_node[5];
  // First order in a strain of 0.3 %.
  EXPECT_NEAR(1 - tube.pose().radial_scale[slot], strain, 0.01 * strain);
  EXPECT_EQ(tube.pose().radial_scale[tube.tree().slot_of_node[4]], 1);
  tube.set_squeeze(5, 1e9);
  for (int i = 0; i < 200; ++i) tube.step();
  EXPECT_GT(tube.pose().radial_scale[slot], 0);
}

TEST(Simulation, RefusesWhatItCannotDo) {
  const Centerline rod = straight_rod(3, 30, 1);
  EXPECT_THROW(simulate(rod, {.young_Pa = -1}, {}), InvalidInput);
  EXPECT_THROW(simulate(rod, {.poisson_ratio = 0.7}, {}), InvalidInput);
  EXPECT_THROW(CenterlineSimulation(rod, {}, {}), InvalidInput);
  SimulationOptions options;
  options.step_s = 0;
  EXPECT_THROW(simulate(rod, {}, options), InvalidInput);
  CenterlineSimulation simulation = simulate(rod, {}, {});
  EXPECT_THROW(simulation.fix(4), InvalidInput);
  EXPECT_THROW(simulation.set_force(1, Vec3(NAN, 0, 0)), InvalidInput);
  EXPECT_THROW(simulation.set_radial_scale(1, 0), InvalidInput);
}

}  // namespace
}  // namespace vmesh::testing
