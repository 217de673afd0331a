#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "vmesh/deform/simulation.h"

namespace vmesh::testing {

/// A straight rod along x from the origin, node i at i / segments of its length.
inline Centerline straight_rod(int segments, double length, double radius) {
  std::vector<CenterlineNode> nodes{{Vec3::Zero(), radius}};
  std::vector<CenterlineSegment> joined;
  for (Index i = 1; i <= static_cast<Index>(segments); ++i) {
    nodes.push_back({Vec3(length * i / segments, 0, 0), radius});
    joined.push_back({i - 1, i});
  }
  return {nodes, joined};
}

/// A step so long that inertia does not matter: one step ends in equilibrium.
inline SimulationOptions statics() {
  SimulationOptions options;
  options.step_s = 1e4;
  options.iterations = 50;
  return options;
}

inline CenterlineSimulation simulate(const Centerline& centerline, const Material& material,
                                     const SimulationOptions& options) {
  return {centerline, segment_properties(centerline, material), options};
}

inline double energy_J(const CenterlineSimulation& simulation) {
  return simulation.kinetic_energy_J() + simulation.elastic_energy_J();
}

inline double area_mm2(double radius) { return std::numbers::pi * radius * radius; }
inline double second_moment_mm4(double radius) { return 0.25 * std::numbers::pi * std::pow(radius, 4); }

}  // namespace vmesh::testing
