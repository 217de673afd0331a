#include <gtest/gtest.h>

#include "vmesh/synth/synthetic_tree.h"

#include "chains.h"
#include "draw.h"

namespace vmesh::testing {
namespace {

TEST(Energy, NeverGrowsWithoutDampingAndLoad) {
  SyntheticTreeOptions shape;
  shape.vertices = 20;
  const Centerline tree = synthetic_tree(shape);
  SimulationOptions options;
  options.step_s = 1e-3;
  options.rest_tolerance = 0;
  Material material;
  material.damping_s = 0;
  CenterlineSimulation simulation = simulate(tree, material, options);
  simulation.clamp(0);
  Draw draw(5);
  for (Index n = 1; n < tree.nodes().size(); ++n) simulation.set_velocity(n, draw.in_cube(2000));
  double energy = energy_J(simulation);
  const double first = energy;
  for (int i = 0; i < 100'000; ++i) {
    simulation.step();
    const double now = energy_J(simulation);
    // Rounding of a sum of a few hundred squares.
    ASSERT_LE(now, energy + 1e-12 * first) << i;
    energy = now;
  }
}

}  // namespace
}  // namespace vmesh::testing
