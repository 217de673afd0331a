// The plain union of round cones: blend 0.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"

namespace vmesh {
namespace {

using testing::all_cones;
using testing::closest_of;
using testing::Draw;

using testing::kEps;

void expect_same(const FieldSample& actual, const FieldSample& expected) {
  EXPECT_EQ(actual.distance, expected.distance);
  EXPECT_EQ(actual.cone, expected.cone);
  EXPECT_EQ(actual.t, expected.t);
  EXPECT_EQ(actual.gradient, expected.gradient);
}

TEST(Union, GlobalDistanceIsTheLeastOverAllCones) {
  Draw draw(41);
  for (int trial = 0; trial < 100; ++trial) {
    const Centerline centerline = testing::random_graph(draw, 1 + draw.below(40));
    const VesselField field(centerline);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = draw.in_cube(6);
      expect_same(field.sample_global(p), closest_of(field, p, all_cones(field)));
    }
  }
}

TEST(Union, GlobalTiesGoToTheLowestCone) {
  Draw draw(42);
  int ties = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // Tenths are not exact in binary: the bounds by which cones are skipped round differently from the distances.
    const double pitch = trial % 2 == 0 ? 1 : 0.1;
    const Centerline centerline = testing::random_grid_graph(draw, 24, pitch);
    const VesselField field(centerline);
    for (int i = 0; i < 400; ++i) {
      const Vec3 p = pitch * Vec3(draw.below(17) / 2.0 - 2, draw.below(17) / 2.0 - 2, draw.below(17) / 2.0 - 2);
      const auto expected = closest_of(field, p, all_cones(field));
      for (Index c = expected.cone + 1; c < field.relations().cone_count(); ++c) {
        ties += field.sample_cone(p, c).distance == expected.distance;
      }
      expect_same(field.sample_global(p), expected);
    }
  }
  EXPECT_GT(ties, 1000);  // or the test says nothing
}

TEST(Union, LocalDistanceIsTheLeastOverTheConesAroundTheClosest) {
  Draw draw(43);
  for (int trial = 0; trial < 100; ++trial) {
    const Centerline centerline =
        trial % 2 == 0 ? testing::random_graph(draw, 1 + draw.below(40)) : testing::random_grid_graph(draw, 24, 1);
    const VesselField field(centerline);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.in_cube(6);
      const auto hint = draw.below(static_cast<Index>(field.relations().cone_count()));
      const auto s = field.sample(p, hint);
      expect_same(s, closest_of(field, p, field.relations().local_cones(s.cone)));
      EXPECT_LE(s.distance, closest_of(field, p, field.relations().local_cones(hint)).distance);
      expect_same(field.sample(p, s.cone), s);  // it is a hint that stays
    }
  }
}

// So many branches at one node that their cones are looked for in space; a third of them begins with the hub's sphere.
TEST(Union, LocalDistanceIsTheLeastAroundANodeOfManyBranchesToo) {
  Draw draw(46);
  std::vector<CenterlineNode> nodes = {{Vec3::Zero(), 2}};
  std::vector<CenterlineSegment> segments;
  for (int branch = 0; branch < 600; ++branch) {
    const Vec3 way = draw.direction();
    for (int k = 0; k < 3; ++k) {
      const auto next = static_cast<Index>(nodes.size());
      segments.push_back({k == 0 ? 0 : next - 1, next});
      nodes.push_back({(3 + 4 * k) * way, 0.3});
    }
  }
  const Centerline centerline(nodes, segments);
  const VesselField field(centerline);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = draw.in_cube(6);
    const auto s = field.sample(p, draw.below(static_cast<Index>(field.relations().cone_count())));
    EXPECT_GT(field.relations().local_cones(0).size(), 512u);
    expect_same(s, closest_of(field, p, field.relations().local_cones(s.cone)));
  }
}

TEST(Union, DistanceToOthersIsTheLeastOfThoseThatAreNotLocal) {
  Draw draw(47);
  int limited = 0, unlimited = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Centerline centerline =
        trial % 2 == 0 ? testing::random_graph(draw, 1 + draw.below(40)) : testing::random_grid_graph(draw, 24, 1);
    const VesselField field(centerline);
    for (int i = 0; i < 50; ++i) {
      const auto cone = draw.below(static_cast<Index>(field.relations().cone_count()));
      const auto local = field.relations().local_cones(cone);
      const Vec3 p = field.relations().axis_point(cone, draw.uniform(0, 1)) + draw.uniform(0, 2) * draw.direction();
      const double limit = draw.uniform(-0.5, 2);
      double least = limit;
      for (Index other = 0; other < field.relations().cone_count(); ++other) {
        if (!std::binary_search(local.begin(), local.end(), other))
          least = std::min(least, field.sample_cone(p, other).distance);
      }
      EXPECT_EQ(field.distance_to_others(p, cone, limit), least);
      ++(least < limit ? limited : unlimited);
    }
  }
  EXPECT_GT(limited, 100);
  EXPECT_GT(unlimited, 100);
}

// Whatever the direction: the union is outside all its cones, and within a cone the distance is the depth.
TEST(Union, AStepOfTheDistanceNeverCrossesTheBoundary) {
  Draw draw(44);
  int inside = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Centerline centerline = testing::random_graph(draw, 1 + draw.below(20));
    const VesselField field(centerline);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.in_cube(5);
      const auto check = [&](const FieldSample& s, const auto& at) {
        const double tolerance = 64 * kEps * 20;  // coordinates, lengths and radii add up to less than 20
        for (int k = 0; k < 4; ++k) {
          const double there = at(p + std::abs(s.distance) * draw.direction());
          if (s.distance < 0) {
            EXPECT_LE(there, tolerance);
          } else {
            EXPECT_GE(there, -tolerance);
          }
        }
        // Along the gradient an outside point reaches the boundary, no less.
        if (s.distance > 0) {
          EXPECT_LE(std::abs(at(p - s.distance * s.gradient)), tolerance);
        }
      };
      const auto s = field.sample_global(p);
      inside += s.distance < 0;
      check(s, [&](const Vec3& q) { return field.sample_global(q).distance; });
      const auto local = field.sample(p, draw.below(static_cast<Index>(field.relations().cone_count())));
      check(local,
            [&](const Vec3& q) { return closest_of(field, q, field.relations().local_cones(local.cone)).distance; });
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(Union, GradientIsTheDerivativeWhereOneConeIsClosest) {
  Draw draw(45);
  int tested = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const Centerline centerline = testing::random_graph(draw, 12);
    const VesselField field(centerline);
    for (int i = 0; i < 50; ++i) {
      const Vec3 p = draw.in_cube(5);
      const auto s = field.sample_global(p);
      const double base = s.distance + field.relations().radius_at(s.cone, s.t);
      if (base < 0.1) continue;
      const double h = 1e-6 * base;
      bool alone = true;
      for (Index c = 0; c < field.relations().cone_count(); ++c) {
        if (c != s.cone && field.sample_cone(p, c).distance < s.distance + 4 * h) alone = false;
      }
      if (!alone) continue;
      ++tested;
      EXPECT_NEAR(s.gradient.norm(), 1, 4 * kEps);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        const double difference =
            (field.sample_global(p + step).distance - field.sample_global(p - step).distance) / (2 * h);
        // The gradient turns by at most h / base; sizes below 20 round, over 2 h.
        EXPECT_NEAR(difference, s.gradient[axis], 1.1 * h / base + 32 * kEps * 20 / h);
      }
    }
  }
  EXPECT_GT(tested, 1000);
}

TEST(VesselField, RefusesABlendOutOfRange) {
  const Centerline centerline({{{0, 0, 0}, 1}}, {});
  for (const double blend : {-1e-9, 2.0001, -HUGE_VAL, HUGE_VAL, std::nan("")}) {
    EXPECT_THROW(VesselField(centerline, blend), InvalidInput) << blend;
  }
  for (const double blend : {0.0, 0.5, 2.0}) EXPECT_NO_THROW(VesselField(centerline, blend)) << blend;
}

}  // namespace
}  // namespace vmesh
