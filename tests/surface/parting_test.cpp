// Walls of finished pieces that cross each other are parted in place, or left and reported.
#include "surface/pieces/parting.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

// Two tubes side by side, as one surface of two pieces.
struct SideBySide {
  explicit SideBySide(double gap)
      : centerline({{{0, 0, 0}, 1}, {{20, 0, 0}, 1}, {{0, 2 + gap, 0}, 1}, {{20, 2 + gap, 0}, 1}}, {{0, 1}, {2, 3}}),
        field(centerline, GenerateOptions().blend) {
    const GenerateResult grown = generate_surface(centerline, {});
    surface.mesh = grown.mesh;
    surface.binding = grown.binding;
    surface.radius = grown.radius;
  }

  // The vertex of the first tube nearest to the middle of the second.
  Index nearest() const {
    const Vec3 p(10, centerline.node(2).position.y(), 0);
    Index best = kNone;
    for (Index v = 0; v < surface.binding.size(); ++v) {
      if (surface.binding[v].segment != 0) continue;
      if (best == kNone || (surface.mesh.vertices[v] - p).norm() < (surface.mesh.vertices[best] - p).norm()) best = v;
    }
    return best;
  }

  Centerline centerline;
  VesselField field;
  GatheredSurface surface;
};

TEST(Parting, TakesAVertexBackThatStandsInAnotherWall) {
  SideBySide tubes(0.3);
  const Index v = tubes.nearest();
  tubes.surface.mesh.vertices[v].y() += 0.5;
  const auto crossings = self_intersections(tubes.surface.mesh);
  ASSERT_FALSE(crossings.empty());
  const GatheredSurface before = tubes.surface;
  EXPECT_TRUE(part_walls(tubes.surface, tubes.field, crossings).empty());
  EXPECT_TRUE(self_intersections(tubes.surface.mesh).empty());
  const Topology topology = measure_topology(tubes.surface.mesh);
  EXPECT_TRUE(topology.closed && topology.manifold);
  EXPECT_EQ(topology.components, 2u);
  const std::vector<double> skewness = equiangle_skewness(tubes.surface.mesh);
  EXPECT_LE(*std::max_element(skewness.begin(), skewness.end()), 0.5);
  // Only what lies around the place has changed.
  for (Index u = 0; u < before.mesh.vertices.size(); ++u) {
    EXPECT_TRUE(u == v || tubes.surface.mesh.vertices[u] == before.mesh.vertices[u]);
  }
}

TEST(Parting, TellsJustWhatStillCrosses) {
  for (const double pushed : {0.4, 0.5, 0.6, 0.8}) {
    SideBySide tubes(0.3);
    const Index v = tubes.nearest();
    for (const Triangle& f : tubes.surface.mesh.faces) {
      if (std::find(f.begin(), f.end(), v) == f.end()) continue;
      for (const Index w : f) {
        if (w > v) tubes.surface.mesh.vertices[w].y() += pushed;
      }
    }
    tubes.surface.mesh.vertices[v].y() += pushed;
    const auto crossings = self_intersections(tubes.surface.mesh);
    ASSERT_FALSE(crossings.empty());
    EXPECT_EQ(part_walls(tubes.surface, tubes.field, crossings), self_intersections(tubes.surface.mesh)) << pushed;
    EXPECT_TRUE(measure_topology(tubes.surface.mesh).closed);
  }
}

TEST(Parting, TellsWhatNoStepParts) {
  SideBySide tubes(0.3);
  for (Index v = 0; v < tubes.surface.binding.size(); ++v) {
    if (tubes.surface.binding[v].segment == 0) tubes.surface.mesh.vertices[v].y() += 1;
  }
  const auto crossings = self_intersections(tubes.surface.mesh);
  ASSERT_FALSE(crossings.empty());
  const auto left = part_walls(tubes.surface, tubes.field, crossings);
  EXPECT_FALSE(left.empty());
  EXPECT_EQ(left, self_intersections(tubes.surface.mesh));
}

TEST(Parting, CanBeTakenBack) {
  SideBySide tubes(0.3);
  tubes.surface.mesh.vertices[tubes.nearest()].y() += 0.5;
  const auto crossings = self_intersections(tubes.surface.mesh);
  const GatheredSurface before = tubes.surface;
  BeforeParting remembered;
  part_walls(tubes.surface, tubes.field, crossings, &remembered);
  ASSERT_NE(tubes.surface.mesh.vertices, before.mesh.vertices);
  take_back(remembered, tubes.surface);
  EXPECT_EQ(tubes.surface.mesh.vertices, before.mesh.vertices);
  EXPECT_EQ(tubes.surface.mesh.faces, before.mesh.faces);
  EXPECT_EQ(tubes.surface.radius, before.radius);
  for (Index v = 0; v < before.binding.size(); ++v) EXPECT_EQ(tubes.surface.binding[v].t, before.binding[v].t);
}

}  // namespace
}  // namespace vmesh
