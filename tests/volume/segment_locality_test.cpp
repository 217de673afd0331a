// Cones that are local beyond what counts as one volume, because the rounding between them extends farther.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"

namespace vmesh {
namespace {

using testing::CenterlineBuilder;
using testing::Draw;

bool sees(const VesselField& field, Index i, Index j) {
  const auto cones = field.relations().local_cones(i);
  return std::binary_search(cones.begin(), cones.end(), j);
}

double least_rounding(const VesselField& field) {
  double least = 1;
  for (Index c = 0; c < field.relations().cone_count(); ++c)
    least = std::min(least, field.relations().rounding_at(c, 0));
  return least;
}

// Two daughters of radius 1 that part at a small angle; their segments come in turns, half a radius long.
Centerline shallow_fork(double degrees, double length) {
  CenterlineBuilder tree;
  const Index fork = tree.add({0, 0, 0}, 1);
  Index up = fork, down = fork;
  const double half = degrees / 2 * std::numbers::pi / 180;
  for (double s = 0.5; s <= length; s += 0.5) {
    up = tree.add({s * std::cos(half), s * std::sin(half), 0}, 1, up);
    down = tree.add({s * std::cos(half), -s * std::sin(half), 0}, 1, down);
  }
  return tree.build();
}

TEST(SegmentLocality, ReachesAsFarAsTheBlend) {
  constexpr double kAngle = 4;
  const Centerline centerline = shallow_fork(kAngle, 60);
  // Beyond the default blend it reaches no farther, and the rounding is reduced to end there.
  for (const auto& [blend, reach] : {std::pair(0.0, 0.5), {0.2, 0.5}, {0.4, 0.8}, {0.5, 1.0}, {0.6, 1.0}, {2.0, 1.0}}) {
    const VesselField field(centerline, blend);
    const double least = least_rounding(field);
    if (blend > 0.5) {
      EXPECT_LE(2 * blend * least, 1);
    } else if (blend == 0.2) {
      // Beside the last spheres that touch are some that face each other obliquely, across a gap hardly less than the
      // blend: nine tenths of what would fill it are left.
      EXPECT_GE(least, 0.88);
    } else {
      EXPECT_EQ(least, 1);
    }
    double last_seen = 0, last_one = 0;
    for (Index i = 0; i < field.relations().cone_count(); i += 2) {
      const Vec3 p = field.relations().axis_point(i, 0.5), q = field.relations().axis_point(i + 1, 0.5);
      const double gap = (p - q).norm() - 2;
      if (sees(field, i, i + 1)) last_seen = gap;
      if (field.relations().are_one_volume(i, i + 1)) last_one = gap;
      EXPECT_EQ(sees(field, i, i + 1), sees(field, i + 1, i));
    }
    // A segment is seen as a whole, from the sphere before it on: the gap grows by 0.035 along each.
    const double step = 0.5 * 2 * std::sin(kAngle / 2 * std::numbers::pi / 180);
    EXPECT_NEAR(last_seen, reach, 2 * step) << "blend " << blend;
    EXPECT_NEAR(last_one, std::clamp(blend, 0.1, 0.5), 2 * step) << "blend " << blend;
  }
}

// A ring of radius 1.4, so that 0.8 are left between opposite walls, that does not close: it comes down from above, and
// `gap` is left between where it began and its end.
Centerline open_ring(double gap) {
  constexpr double kRing = 1.4, kStep = 0.1;
  const double mouth = 2 * std::asin((2 + gap) / (2 * kRing));  // the angle between begin and end
  CenterlineBuilder ring;
  Index last = kNone;
  for (double z = 6; z > kStep / 2; z -= kStep) last = ring.add({kRing, 0, z}, 1, last);
  for (double angle = 0; angle < 2 * std::numbers::pi - mouth + kStep / 2; angle += kStep)
    last = ring.add({kRing * std::cos(angle), kRing * std::sin(angle), 0}, 1, last);
  return ring.build();
}

struct Mouth {
  Index begin = kNone, end = kNone;  // cones
  Vec3 middle = Vec3::Zero();
  double gap = 0;
};

Mouth mouth_of(const VesselField& field) {
  Mouth mouth;
  mouth.end = static_cast<Index>(field.relations().cone_count() - 1);
  mouth.gap = 1e9;
  for (Index c = 0; c < 60; ++c) {
    const Vec3 p = field.relations().axis_point(c, 1), q = field.relations().axis_point(mouth.end, 1);
    if ((p - q).norm() - 2 >= mouth.gap) continue;
    mouth.begin = c;
    mouth.gap = (p - q).norm() - 2;
    mouth.middle = 0.5 * (p + q);
  }
  return mouth;
}

TEST(SegmentLocality, LeavesWallsApartThatMeetAgain) {
  for (const double gap : {0.45, 0.5}) {
    const Centerline centerline = open_ring(gap);
    const VesselField field(centerline, 0.5);
    const Mouth mouth = mouth_of(field);
    EXPECT_GT(mouth.gap, 0.4);
    EXPECT_TRUE(sees(field, mouth.begin, mouth.end));
    EXPECT_FALSE(field.relations().are_one_volume(mouth.begin, mouth.end));
    EXPECT_LT(least_rounding(field), 1);
    EXPECT_LT(mouth.gap, 0.5);  // with all of the blend the walls would meet
    for (const Index hint : {mouth.begin, mouth.end}) EXPECT_GT(field.sample(mouth.middle, hint).distance, 0);
  }
}

TEST(SegmentLocality, EndsBeforeWallsThatMeetAgainClosely) {
  const Centerline centerline = open_ring(0.15);
  const VesselField field(centerline, 0.5);
  const Mouth mouth = mouth_of(field);
  EXPECT_LT(mouth.gap, 0.25);
  EXPECT_FALSE(sees(field, mouth.begin, mouth.end));
  // On their walls, no rounding reaches across the gap.
  Draw draw(5);
  int points = 0;
  for (int k = 0; k < 2000; ++k) {
    const Index hint = k % 2 == 0 ? mouth.begin : mouth.end;
    Vec3 p = mouth.middle + draw.in_cube(0.3);
    for (int step = 0; step < 20; ++step) {
      const FieldSample s = field.sample(p, hint);
      p -= s.distance * s.gradient;
    }
    if (std::abs(field.sample(p, hint).distance) > 1e-12) continue;
    ++points;
    EXPECT_NEAR(field.sample_global(p).distance, 0, 1e-12) << p.transpose();
  }
  EXPECT_GT(points, 1000);
}

// From where two daughters have parted, along the boundary to where they join: the distance there is continuous,
// whatever cone is the nearest. Returns how much it changes over a thousandth of a radius, at most, in thousandths.
double steepest_way(const VesselField& field, Draw& draw) {
  constexpr double kStep = 1e-3;
  double steepest = 0;
  for (int walk = 0; walk < 6; ++walk) {
    const auto start = static_cast<Index>(field.relations().cone_count() - 1 - draw.below(2));
    Vec3 p = field.relations().axis_point(start, 0.5);
    p += Vec3(0, p.y() > 0 ? -1 : 1, draw.uniform(-0.4, 0.4)).normalized();
    FieldSample s = field.sample(p, start);
    for (int k = 0; k < 20000; ++k) {
      p -= s.distance * s.gradient;
      const FieldSample here = field.sample(p, s.cone);
      const Vec3 back = Vec3(-1, 0, 0) + here.gradient.x() * here.gradient;
      if (back.norm() < 0.1) break;
      p += kStep * back.normalized();
      s = field.sample(p, here.cone);
      steepest = std::max(steepest, std::abs(s.distance - here.distance) / kStep);
    }
  }
  return steepest;
}

TEST(SegmentLocality, EndsWithoutAStep) {
  Draw draw(6);
  for (const double degrees : {8.0, 15.0, 30.0, 45.0}) {
    const Centerline centerline = shallow_fork(degrees, 3.5 / (2 * std::sin(degrees / 2 * std::numbers::pi / 180)));
    for (const double blend : {0.0, 0.3, 0.5})
      EXPECT_LE(steepest_way(VesselField(centerline, blend), draw), 1.5) << degrees << " degrees, blend " << blend;
  }
}

// Two thick vessels less than half a radius apart, and between them a twig.
Centerline twig_between_thick_ones() {
  return {{{{0, 0, 0}, 2.5},
           {{3.8, 0, 0}, 2.5},
           {{6.2, 0.8, 0}, 0.06},
           {{9.2, 0.8, 0.3}, 0.24},
           {{9.6, -0.5, 0}, 2.9},
           {{12.6, -0.5, 0}, 0.8}},
          {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}};
}

TEST(SegmentLocality, OfATwigDoesNotJoinWhatIsNotLocal) {
  const Centerline centerline = twig_between_thick_ones();
  const VesselField field(centerline, 0.5);
  ASSERT_TRUE(sees(field, 2, 1) && sees(field, 2, 3));
  ASSERT_FALSE(sees(field, 1, 3));
  EXPECT_FALSE(field.are_blended(1, 3));
  // The distance beside the twig changes by no more than the distance moved, whichever cone is nearest.
  constexpr double kStep = 1e-3;
  for (const double beside : {0.1, 0.2, 0.3}) {
    Index hint = 2;
    double last = field.sample({6.2, 0.8 + beside, 0}, hint).distance;
    for (double x = 6.2 + kStep; x < 7.2; x += kStep) {
      const FieldSample s = field.sample({x, 0.8 + beside, 0}, hint);
      EXPECT_LE(std::abs(s.distance - last), 1.01 * kStep) << beside << " beside at " << x;
      hint = s.cone;
      last = s.distance;
    }
  }
}

}  // namespace
}  // namespace vmesh
