// The field of a moved, turned or scaled vessel is the moved, turned or scaled field.
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"

namespace vmesh {
namespace {

using testing::Draw;

using testing::kEps;

template <class Map>
Centerline mapped(const Centerline& centerline, double scale, Map&& map) {
  auto nodes = centerline.nodes();
  for (auto& n : nodes) n = {map(n.position), scale * n.radius};
  return Centerline(std::move(nodes), centerline.segments());
}

TEST(Equivariance, UnderPowersOfTwoIsExact) {
  Draw draw(71);
  for (const double scale : {0x1p-30, 0.5, 0x1p20}) {
    for (const double blend : {0.0, 0.5, 2.0}) {
      for (int trial = 0; trial < 10; ++trial) {
        const Centerline centerline = testing::random_graph(draw, 20);
        const Centerline scaled = mapped(centerline, scale, [&](const Vec3& p) -> Vec3 { return scale * p; });
        const VesselField field(centerline, blend), other(scaled, blend);
        for (Index c = 0; c < field.relations().cone_count(); ++c) {
          EXPECT_TRUE(std::ranges::equal(field.relations().local_cones(c), other.relations().local_cones(c)));
        }
        for (int i = 0; i < 50; ++i) {
          const Vec3 p = draw.in_cube(6);
          const auto hint = draw.below(static_cast<Index>(field.relations().cone_count()));
          for (const auto& [s, t] : {std::pair(field.sample_global(p), other.sample_global(scale * p)),
                                     {field.sample(p, hint), other.sample(scale * p, hint)}}) {
            EXPECT_EQ(t.distance, scale * s.distance);
            EXPECT_EQ(t.gradient, s.gradient);
            EXPECT_EQ(t.cone, s.cone);
            EXPECT_EQ(t.t, s.t);
          }
        }
      }
    }
  }
}

// A rigid motion rounds every coordinate of every node and of the query: three products and three sums of numbers of
// size M, at most 4 eps M each, 7 eps M per point. The distance is 1-Lipschitz in the query and in the nodes, and its
// own evaluation adds a dozen rounding errors on either side. 64 eps M covers all of it, M the largest norm around.
//
// Cones that meet at a node tie wherever the node is closest, and rounding decides which one a local query goes on
// from: where that leads to different cones, these graphs of long crossing segments may show different vessels.
TEST(Equivariance, UnderRigidMotionsIsExactToRounding) {
  Draw draw(72);
  int same = 0, tied = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Centerline centerline = testing::random_graph(draw, 20);
    const Eigen::AngleAxisd turn(draw.uniform(-3, 3), draw.direction());
    const Eigen::Matrix3d rotation = turn.toRotationMatrix();
    const Vec3 shift = draw.in_cube(trial % 2 == 0 ? 10 : 1000);
    const auto move = [&](const Vec3& p) -> Vec3 { return rotation * p + shift; };
    const Centerline moved = mapped(centerline, 1, move);
    const double size = 12 + shift.norm();  // points and nodes are within 6 sqrt(3) of the origin
    const double tolerance = 64 * kEps * size;
    const VesselField field(centerline), other(moved);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = draw.in_cube(6);
      for (Index c = 0; c < field.relations().cone_count(); ++c) {
        EXPECT_NEAR(other.sample_cone(move(p), c).distance, field.sample_cone(p, c).distance, tolerance);
      }
      const auto s = field.sample_global(p), t = other.sample_global(move(p));
      EXPECT_NEAR(t.distance, s.distance, tolerance);
      const auto hint = draw.below(static_cast<Index>(field.relations().cone_count()));
      const auto local = field.sample(p, hint), local_moved = other.sample(move(p), hint);
      if (local.cone == local_moved.cone) {
        EXPECT_NEAR(local_moved.distance, local.distance, tolerance);
      }
      (local.cone == local_moved.cone ? same : tied) += 1;
      // A gradient is as good as its base is long.
      const double base = s.distance + field.relations().radius_at(s.cone, s.t);
      if (s.cone == t.cone && base > 0.1 && std::abs(s.t - t.t) < 1e-9) {
        EXPECT_LT((t.gradient - rotation * s.gradient).norm(), 10 * tolerance / base);
      }
    }
  }
  EXPECT_LT(tied, same / 20);
}

}  // namespace
}  // namespace vmesh
