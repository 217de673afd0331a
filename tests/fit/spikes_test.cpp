#include "fit/spikes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/surface/generate.h"

#include "fit/unmatched.h"

namespace vmesh::fitting {
namespace {

TriMesh tube(const Centerline& centerline, int around) {
  GenerateOptions options;
  options.around = around;
  options.threads = 1;
  return generate_surface(centerline, options).mesh;
}

/// A coarse tube, one vertex of which is pulled out of its wall.
class Spike : public ::testing::Test {
 protected:
  Spike() {
    std::vector<FitVertex> vertices;
    for (const Vec3& p : mesh_.vertices) vertices.push_back({p, 0, kNone, 1, 1});
    surface_ = FitMesh(mesh_.faces, vertices);
    for (Index v = 0; v < mesh_.vertices.size(); ++v) {
      if (std::abs(mesh_.vertices[v].x() - 6) < std::abs(mesh_.vertices[spike_].x() - 6)) spike_ = v;
    }
    foot_ = surface_.position(spike_);
    normal_ = surface_.vertex_normal(spike_);
  }

  void pull(double height) { surface_.edit(spike_).position = foot_ + height * normal_; }

  void collapse(const TriMesh& reference, const std::vector<char>& frozen = {}) {
    const FitReference target(reference, field_);
    collapse_spikes(surface_, frozen, {target, field_, {}, {}});
  }

  Centerline centerline_{{{{0, 0, 0}, 2}, {{12, 0, 0}, 2}}, {{0, 1}}};
  VesselField field_{centerline_};
  TriMesh mesh_ = tube(centerline_, 6);
  FitMesh surface_;
  Index spike_ = 0;
  Vec3 foot_, normal_;
};

TEST_F(Spike, IsCollapsed) {
  pull(2.5);
  collapse(tube(centerline_, 24));
  EXPECT_FALSE(surface_.has_vertex(spike_));
  EXPECT_EQ(surface_.vertex_count(), mesh_.vertices.size() - 1);
  surface_.pack();
  const Topology topology = measure_topology(surface_.tri_mesh());
  EXPECT_TRUE(topology.manifold && topology.oriented);
  EXPECT_EQ(topology.euler_characteristic, 2);
  EXPECT_TRUE(self_intersections(surface_.tri_mesh()).empty());
}

TEST_F(Spike, StaysWhereTheReferenceHasOneToo) {
  pull(2.5);
  collapse(surface_.tri_mesh());
  EXPECT_TRUE(surface_.has_vertex(spike_));
}

TEST_F(Spike, StaysWhereItIsFrozen) {
  pull(2.5);
  std::vector<char> frozen(mesh_.vertices.size(), 0);
  frozen[spike_] = 1;
  collapse(tube(centerline_, 24), frozen);
  EXPECT_TRUE(surface_.has_vertex(spike_));
}

TEST_F(Spike, StaysWhereItIsBlunt) {
  pull(0.6);
  collapse(tube(centerline_, 24));
  EXPECT_TRUE(surface_.has_vertex(spike_));
}

// In front of a tip, a point lies behind some of the faces that share it.
TEST_F(Spike, IsSeenFromOutside) {
  pull(2.5);
  const Vec3 tip = surface_.position(spike_), u = normal_.unitOrthogonal(), w = normal_.cross(u);
  for (int i = 0; i < 36; ++i) {
    const double angle = i * std::numbers::pi / 18;
    const Vec3 p = tip + normal_ + 1.2 * (std::cos(angle) * u + std::sin(angle) * w);
    TriMesh wall = tube(centerline_, 24);
    const auto first = static_cast<Index>(wall.vertices.size());
    for (const Vec3& corner : {u, w, Vec3(-u - w)}) wall.vertices.push_back(p + 0.01 * corner);
    wall.faces.push_back({first, first + 1, first + 2});
    const auto parts = uncovered_parts(surface_, FitReference(wall, field_), field_).unmatched;
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const UnmatchedPart& found) { return (found.position - p).norm() < 0.1; });
    ASSERT_NE(part, parts.end());
    EXPECT_FALSE(part->inside) << angle;
  }
}

}  // namespace
}  // namespace vmesh::fitting
