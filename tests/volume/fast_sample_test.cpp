// Local queries in single precision.
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"
#include "volume/cone_lanes.h"

namespace vmesh {
namespace {

using testing::Draw;

// A vessel of many short segments that bends slightly at every node, like real centerlines, with side branches.
Centerline random_vessel(Draw& draw, int nodes) {
  std::vector<CenterlineNode> places;
  std::vector<CenterlineSegment> segments;
  Vec3 at = draw.in_cube(3), way = draw.in_cube(1).normalized();
  double radius = 1;
  for (int i = 0; i < nodes; ++i) {
    places.push_back({at, radius});
    if (i > 0) segments.push_back({static_cast<Index>(i - 1), static_cast<Index>(i)});
    way = (way + 0.4 * draw.in_cube(1)).normalized();
    at += (0.4 + draw.below(20) / 10.0) * radius * way;
    radius *= 0.9 + draw.below(21) / 100.0;
  }
  for (int i = 1; i + 1 < nodes; i += 4) {
    const Vec3 aside = draw.in_cube(1).normalized();
    const double thin = (0.3 + draw.below(60) / 100.0) * places[static_cast<std::size_t>(i)].radius;
    const auto end = static_cast<Index>(places.size());
    places.push_back({places[static_cast<std::size_t>(i)].position + 4 * aside, thin});
    segments.push_back({static_cast<Index>(i), end});
  }
  return Centerline(std::move(places), std::move(segments));
}

// Points around the walls, and a hint for each.
template <class Visit>
void near_walls(Draw& draw, const VesselField& field, int count, Visit&& visit) {
  for (int i = 0; i < count; ++i) {
    const auto cone = draw.below(static_cast<Index>(field.relations().cone_count()));
    const double t = draw.below(101) / 100.0;
    visit(Vec3(field.relations().axis_point(cone, t) + 1.5 * field.relations().radius_at(cone, t) * draw.in_cube(1)),
          cone);
  }
}

// Coordinates are at most 128 radii from the hint, or double precision is used: rounded to single precision, 128 times
// 6e-8 radii off each; a distance has a dozen such errors. Where two cones are as near, either may be named, and blends
// of cones that are nearly parallel turn by the root of what the cosine between them is off.
TEST(FastSample, IsTheSampleToSinglePrecision) {
  Draw draw(81);
  int near = 0, same = 0;
  for (const double blend : {0.0, 0.5, 2.0}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Centerline centerline = random_vessel(draw, 30);
      const VesselField field(centerline, blend);
      near_walls(draw, field, 200, [&](const Vec3& p, Index hint) {
        const FieldSample exact = field.sample(p, hint), fast = field.sample_fast(p, hint);
        const double radius = field.relations().radius_at(exact.cone, exact.t);
        ++near;
        if (fast.cone != exact.cone) return;  // of a tie, or the walk along the vessel took another way
        ++same;
        EXPECT_NEAR(fast.distance, exact.distance, 1e-4 * radius);
        if (exact.distance > -0.5 * radius) {
          EXPECT_NEAR(fast.t, exact.t, 2e-3);
        }
      });
    }
  }
  EXPECT_GT(same, 0.98 * near);
}

TEST(FastSample, IsExactUnderPowersOfTwo) {
  Draw draw(82);
  for (const double scale : {0x1p-40, 0.5, 0x1p30}) {
    const Centerline centerline = random_vessel(draw, 40);
    auto nodes = centerline.nodes();
    for (auto& n : nodes) n = {scale * n.position, scale * n.radius};
    const Centerline scaled(std::move(nodes), centerline.segments());
    const VesselField field(centerline, 0.5), other(scaled, 0.5);
    near_walls(draw, field, 300, [&](const Vec3& p, Index hint) {
      const FieldSample s = field.sample_fast(p, hint), t = other.sample_fast(scale * p, hint);
      EXPECT_EQ(t.distance, scale * s.distance);
      EXPECT_EQ(t.gradient, s.gradient);
      EXPECT_EQ(t.cone, s.cone);
      EXPECT_EQ(t.t, s.t);
    });
  }
}

TEST(FastSample, IsDoubleWhereSinglePrecisionWillNotDo) {
  // A twig a thousand times thinner than the vessel that it leaves.
  const Centerline centerline({{{0, 0, 0}, 1}, {{3, 0, 0}, 1}, {{0, 40, 0}, 0.001}}, {{0, 1}, {0, 2}});
  const VesselField field(centerline, 0.5);
  for (double y = 1.2; y < 39; y += 0.37) {
    const Vec3 p(0.0011, y, 0.0003);
    const FieldSample exact = field.sample(p, 1), fast = field.sample_fast(p, 1);
    EXPECT_EQ(fast.distance, exact.distance);
    EXPECT_EQ(fast.gradient, exact.gradient);
  }
}

// Any numbers are possible there.
TEST(FastSample, IsTheSameOnEveryMachine) {
#ifdef __x86_64__
  ASSERT_EQ(best_instruction_set() == InstructionSet::avx2, static_cast<bool>(__builtin_cpu_supports("avx2")));
#endif
  LaneSampler &plain = lane_sampler(InstructionSet::plain), &best = lane_sampler(best_instruction_set());
  Draw draw(83);
  const auto number = [&] { return static_cast<float>(draw.in_cube(1).x()); };
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<ConeLanes> lanes(1 + draw.below(kMostConeLanes));
    for (ConeLanes& l : lanes) {
      for (std::size_t i = 0; i < ConeLanes::kCount; ++i) {
        for (ConeLanes::Numbers* n : {&l.origin_x, &l.origin_y, &l.origin_z}) (*n)[i] = 3 * number();
        for (ConeLanes::Numbers* n : {&l.axis_x, &l.axis_y, &l.axis_z, &l.taper, &l.lag}) (*n)[i] = number();
        l.r0[i] = 1 + std::abs(number());
        l.inv_length2[i] = 1 / (0.1f + std::abs(number()));
        l.t_low[i] = 0;
        l.t_high[i] = 1;
        l.reach[i] = l.r0[i];
      }
      l.center_x = l.center_y = l.center_z = 0;
      l.radius = 4;
    }
    const LaneQuery query{2 * number(), 2 * number(), 2 * number(), 0.5f, draw.below(static_cast<Index>(lanes.size()))};
    const LaneSample a = plain(lanes.data(), lanes.size(), query), b = best(lanes.data(), lanes.size(), query);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.gradient_x, b.gradient_x);
    EXPECT_EQ(a.gradient_y, b.gradient_y);
    EXPECT_EQ(a.gradient_z, b.gradient_z);
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.least, b.least);
    EXPECT_EQ(a.nearest, b.nearest);
  }
}

// Cached surroundings of one field are not used for another.
TEST(FastSample, KnowsItsFieldFromOthersAtItsPlace) {
  for (const double radius : {1.0, 2.0, 3.0}) {
    const Centerline centerline({{{0, 0, 0}, radius}, {{5, 0, 0}, radius}}, {{0, 1}});
    const VesselField field(centerline);
    EXPECT_NEAR(field.sample_fast({2, 4, 0}, 0).distance, 4 - radius, 1e-5);
  }
}

}  // namespace
}  // namespace vmesh
