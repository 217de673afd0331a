// The exact signed distance to a single round cone.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/volume/vessel_field.h"

#include "random_centerline.h"

namespace vmesh {
namespace {

using testing::Draw;

using testing::kEps;

struct RoundCone {
  CenterlineNode a, b;

  Centerline centerline() const { return Centerline({a, b}, {{0, 1}}); }
  double length() const { return (b.position - a.position).norm(); }
  /// Everything that is added up in a distance from `p`: the unit in which rounding errors are counted.
  double size(const Vec3& p) const {
    return (p - a.position).norm() + length() + a.radius + b.radius + a.position.norm() + b.position.norm();
  }
  /// Distance of `p` to the sphere at parameter t, one of those that sweep the cone.
  double sphere_distance(const Vec3& p, double t) const {
    return (p - (1 - t) * a.position - t * b.position).norm() - ((1 - t) * a.radius + t * b.radius);
  }
};

enum class Shape { general, equal_radii, contained, just_contained, nearly_contained, short_axis };

RoundCone random_cone(Draw& draw, Shape shape) {
  RoundCone cone;
  cone.a = {draw.in_cube(5), draw.uniform(0.05, 3)};
  const double length = shape == Shape::short_axis ? 1e-6 : draw.uniform(0.1, 6);
  cone.b.position = cone.a.position + length * draw.direction();
  switch (shape) {
    case Shape::general:
      cone.b.radius = std::abs(cone.a.radius + draw.uniform(-0.95, 0.95) * length) + 0.01;
      break;
    case Shape::equal_radii:
      cone.b.radius = cone.a.radius;
      break;
    case Shape::contained:
      cone.b.radius = cone.a.radius + draw.uniform(1, 2) * length;
      break;
    case Shape::just_contained:
      cone.b.radius = cone.a.radius + cone.length();
      break;
    case Shape::nearly_contained:
      cone.b.radius = cone.a.radius + length * (1 - std::pow(10, -draw.uniform(2, 12)));
      break;
    case Shape::short_axis:
      cone.b.radius = cone.a.radius * draw.uniform(0.5, 1.5);
      break;
  }
  if (draw.chance(0.5)) std::swap(cone.a, cone.b);
  return cone;
}

constexpr Shape kShapes[] = {Shape::general,        Shape::equal_radii,      Shape::contained,
                             Shape::just_contained, Shape::nearly_contained, Shape::short_axis};

// Near and far, and often right at the boundary or in the cone.
Vec3 random_point(Draw& draw, const RoundCone& cone) {
  const double t = draw.uniform(-0.5, 1.5);
  const Vec3 on_axis = (1 - t) * cone.a.position + t * cone.b.position;
  const double radius = std::max(cone.a.radius, cone.b.radius);
  return on_axis + draw.uniform(0, draw.chance(0.3) ? 10 : 1.5) * radius * draw.direction();
}

// min over t of the distance to the sphere at t. That function is convex in t (a norm of something linear, less
// something linear), so the least of a dense sampling brackets the minimum, which bisection by thirds then closes on.
double brute_force(const RoundCone& cone, const Vec3& p) {
  constexpr int kSamples = 64;
  int best = 0;
  for (int i = 1; i <= kSamples; ++i) {
    if (cone.sphere_distance(p, i * (1.0 / kSamples)) < cone.sphere_distance(p, best * (1.0 / kSamples))) best = i;
  }
  double low = std::max(0, best - 1) * (1.0 / kSamples), high = std::min(kSamples, best + 1) * (1.0 / kSamples);
  for (int i = 0; i < 90; ++i) {  // (2/3)^90 < 1e-15
    const double u = low + (high - low) / 3, v = high - (high - low) / 3;
    (cone.sphere_distance(p, u) < cone.sphere_distance(p, v) ? high : low) =
        cone.sphere_distance(p, u) < cone.sphere_distance(p, v) ? v : u;
  }
  return std::min({cone.sphere_distance(p, low), cone.sphere_distance(p, 0.0), cone.sphere_distance(p, 1.0)});
}

TEST(RoundCone, DistanceIsThatOfTheClosestSphereAlongTheAxis) {
  Draw draw(31);
  for (const Shape shape : kShapes) {
    for (int i = 0; i < 500; ++i) {
      const RoundCone cone = random_cone(draw, shape);
      const Centerline centerline = cone.centerline();
      const VesselField field(centerline);
      for (int k = 0; k < 4; ++k) {
        const Vec3 p = random_point(draw, cone);
        const auto s = field.sample_cone(p, 0);
        EXPECT_EQ(s.cone, 0u);
        EXPECT_GE(s.t, 0);
        EXPECT_LE(s.t, 1);
        // Either side adds a dozen numbers of at most this size; an error of t counts in second order only.
        const double tolerance = 32 * kEps * cone.size(p);
        EXPECT_NEAR(s.distance, brute_force(cone, p), tolerance);
        EXPECT_NEAR(s.distance, (p - field.relations().axis_point(0, s.t)).norm() - field.relations().radius_at(0, s.t),
                    tolerance);
      }
    }
  }
}

// A convex body's signed distance, inside and outside, is the greatest of n.p - h(n) over all directions n, where h is
// the body's extent along n; the gradient is the n that attains it.
TEST(RoundCone, DistanceIsTheHeightAboveTheSupportingPlane) {
  Draw draw(32);
  for (const Shape shape : kShapes) {
    for (int i = 0; i < 500; ++i) {
      const RoundCone cone = random_cone(draw, shape);
      const Centerline centerline = cone.centerline();
      const VesselField field(centerline);
      const Vec3 p = random_point(draw, cone);
      const auto s = field.sample_cone(p, 0);
      const auto height = [&](const Vec3& n) {
        return n.dot(p) - std::max(n.dot(cone.a.position) + cone.a.radius, n.dot(cone.b.position) + cone.b.radius);
      };
      const double tolerance = 32 * kEps * cone.size(p);
      for (int k = 0; k < 20; ++k) EXPECT_LE(height(draw.direction()), s.distance + tolerance);
      // The direction of the gradient is as good as its base is long. Errors of the direction count in second order,
      // except where the plane touches both end spheres (the lateral surface): there the extent has a kink of the
      // axis' length, and for a nearly contained sphere the base's place on the axis is lost to rounding as well.
      const double base = s.distance + field.relations().radius_at(0, s.t);
      if (base < 1e-3 || shape == Shape::nearly_contained || shape == Shape::just_contained) continue;
      EXPECT_NEAR(height(s.gradient), s.distance, tolerance * (1 + 20 * cone.size(p) / base));
    }
  }
}

TEST(RoundCone, GradientIsAUnitVectorAndTheDerivative) {
  Draw draw(33);
  for (const Shape shape : kShapes) {
    for (int i = 0; i < 500; ++i) {
      const RoundCone cone = random_cone(draw, shape);
      const Centerline centerline = cone.centerline();
      const VesselField field(centerline);
      const Vec3 p = random_point(draw, cone);
      const auto s = field.sample_cone(p, 0);
      // The level set through p bends no more than the sphere around the axis point it belongs to: within `base` the
      // gradient turns by at most h / base over a step h. Rounding adds the distances' errors over 2 h.
      const double base = s.distance + field.relations().radius_at(0, s.t);
      if (base < 0.01) continue;
      EXPECT_NEAR(s.gradient.norm(), 1, 4 * kEps);
      const double h = 1e-6 * base;
      Vec3 differences;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        differences[axis] =
            (field.sample_cone(p + step, 0).distance - field.sample_cone(p - step, 0).distance) / (2 * h);
      }
      const double tolerance = 1.1 * h / base + 32 * kEps * cone.size(p) / h;
      EXPECT_LE((differences - s.gradient).cwiseAbs().maxCoeff(), tolerance);
    }
  }
}

TEST(RoundCone, GradientOnTheAxisIsZero) {
  const Centerline centerline({{{1, 2, 3}, 1}, {{5, 2, 3}, 2}}, {{0, 1}});
  const VesselField field(centerline);
  for (const double x : {1.0, 2.5, 5.0}) {
    const auto s = field.sample_cone({x, 2, 3}, 0);
    EXPECT_EQ(s.gradient, Vec3(0, 0, 0));
    EXPECT_EQ(s.t, (x - 1) / 4);
    EXPECT_EQ(s.distance, -field.relations().radius_at(0, s.t));
  }
  EXPECT_EQ(field.sample_cone({0, 2, 3}, 0).gradient, Vec3(-1, 0, 0));  // beyond its end it is not
}

TEST(RoundCone, WhereOneSphereContainsTheOtherIsTheLargerSphere) {
  Draw draw(34);
  for (const double larger : {4.0, 3.0}) {  // |4 - 1| > 2, and = 2
    for (const bool first : {true, false}) {
      const Vec3 center(first ? 0 : 2, 0, 0);
      const Centerline centerline({{{0, 0, 0}, first ? larger : 1}, {{2, 0, 0}, first ? 1 : larger}}, {{0, 1}});
      const VesselField field(centerline);
      for (int i = 0; i < 100; ++i) {
        const Vec3 p = draw.in_cube(6);
        const auto s = field.sample_cone(p, 0);
        EXPECT_EQ(s.t, first ? 0 : 1);
        EXPECT_EQ(s.distance, (p - center).norm() - larger);
        EXPECT_EQ(s.gradient, (p - center) / (p - center).norm());
      }
    }
  }
}

TEST(RoundCone, OfAnIsolatedNodeIsItsSphere) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{9, 0, 0}, 2}, {{4, 0, 0}, 1}, {{0, 9, 0}, 3}}, {{2, 0}});
  const VesselField field(centerline, 0.5);
  ASSERT_EQ(field.relations().cone_count(), 3u);
  for (const auto& [cone, node] : {std::pair<Index, Index>{1, 1}, {2, 3}}) {
    EXPECT_EQ(field.relations().first_node(cone), node);
    EXPECT_EQ(field.relations().last_node(cone), node);
    Draw draw(35);
    for (int i = 0; i < 100; ++i) {
      const Vec3 p = draw.in_cube(12), away = p - centerline.node(node).position;
      const auto s = field.sample_cone(p, cone);
      EXPECT_EQ(s.distance, away.norm() - centerline.node(node).radius);
      EXPECT_EQ(s.gradient, away / away.norm());
      EXPECT_EQ(s.cone, cone);
    }
  }
  EXPECT_EQ(field.relations().first_node(0), 2u);
  EXPECT_EQ(field.relations().last_node(0), 0u);
  EXPECT_EQ(field.relations().axis_point(0, 0.25), Vec3(3, 0, 0));
}

}  // namespace
}  // namespace vmesh
