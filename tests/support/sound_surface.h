// Whether a surface is sound, measured independently of generate_surface().
#pragma once

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/contacts.h"

namespace vmesh::testing {

inline SeparatedCenterline separated(const Centerline& centerline, double blend) {
  SeparationOptions options;
  options.blend = blend;
  return separate_contacts(centerline, options);
}

/// The surface of separated vessels; checks that its own report is correct, and shows any defects.
inline GenerateResult honest_surface(const Centerline& centerline, GenerateOptions options = {}) {
  options.threads = 1;
  GenerateResult result = generate_surface(centerline, options);
  for (const Defect& defect : result.defects) {
    EXPECT_FALSE(defect.message.empty());
    std::fprintf(stderr, "refused: %s: %s\n", std::string(to_string(defect.kind)).c_str(), defect.message.c_str());
  }
  if (!result.is_sound()) return result;
  const TriMesh closed = with_lids(result);
  const Topology topology = measure_topology(closed);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  const bool guided = options.growth == GrowthMethod::guided;  // a summary of growth is of that only
  EXPECT_EQ(topology.components, guided ? result.growth.components : centerline.component_count());
  EXPECT_EQ(topology.genus,
            static_cast<std::int64_t>(guided ? result.growth.cycle_rank : std::size_t{centerline.cycle_rank()}));
  EXPECT_TRUE(self_intersections(closed).empty());
  EXPECT_LE(summarize_skewness(result.mesh).max, kWorstSkewness);
  return result;
}

inline void expect_sound(const Centerline& centerline, const GenerateOptions& options = {}) {
  EXPECT_TRUE(honest_surface(separated(centerline, options.blend).centerline, options).is_sound());
}

/// Expects a sound surface, or a refusal where vessels touch that could not be separated.
inline void expect_sound_or_refused_with_reason(const Centerline& centerline, const GenerateOptions& options = {}) {
  const SeparatedCenterline given = separated(centerline, options.blend);
  const GenerateResult result = honest_surface(given.centerline, options);
  EXPECT_TRUE(result.is_sound() || !given.report.left.empty());
}

}  // namespace vmesh::testing
