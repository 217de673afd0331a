// Properties that every surface must have, whatever its centerline.
#pragma once

#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/deviation.h"
#include "vmesh/surface/generate.h"

namespace vmesh::testing {

/// Closed, manifold, turned outwards, in as many components and with as many holes as the centerline, finite and free
/// of self-intersections.
inline void expect_valid(const Centerline& centerline, const GenerateResult& result) {
  const Topology topology = measure_topology(result.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, centerline.component_count());
  EXPECT_EQ(topology.genus, static_cast<int>(centerline.cycle_rank()));
  EXPECT_EQ(self_intersections(result.mesh).size(), 0u);
  for (const Vec3& v : result.mesh.vertices) ASSERT_TRUE(v.allFinite());
  for (const double r : result.radius) ASSERT_TRUE(std::isfinite(r) && r > 0);
}

/// Valid, proven to keep to a limit of a fifth of the local radius, and measured to.
inline GenerateResult expect_valid_within_a_fifth(const Centerline& centerline, GenerateOptions options = {}) {
  options.max_error.relative = 0.2;
  GenerateResult result = generate_surface(centerline, options);
  expect_valid(centerline, result);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  const Deviation deviation = measure_deviation(result.mesh, result.binding, VesselField(centerline, options.blend));
  EXPECT_LE(deviation.max_relative, 0.2);
  return result;
}

}  // namespace vmesh::testing
