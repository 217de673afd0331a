#pragma once

#include "vmesh/core/types.h"

namespace vmesh {

/// The convex hull of two balls.
struct ContactCone {
  Vec3 a, b;
  double radius_a, radius_b;

  Vec3 axis_at(double t) const { return a + t * (b - a); }
  double radius_at(double t) const { return radius_a + t * (radius_b - radius_a); }
};

/// The distance between two round cones, negative where they overlap, and the parameters on the axes of the balls
/// that are nearest to each other. `direction` points from the second to the first.
struct ConeGap {
  double gap = 0, first_t = 0, second_t = 0;
  Vec3 direction = Vec3::UnitX();
};
ConeGap gap_between(const ContactCone& first, const ContactCone& second);

/// Two keep at least `narrowest` of a gap above twice that; beyond `wide`, all gaps are as good.
struct KeptGap {
  double narrowest, wide;
};

/// How far two cones whose ends move along lines, both from `from` to `to`, can go without their gap, now `gap`,
/// falling to a share of what it is, or of kept.wide if that is less: the part of the way, 1 for all of it. By
/// conservative advancement: no gap changes by more than the ends move relative to each other.
struct ConeMotion {
  ContactCone from, to;
};
ContactCone between(const ConeMotion& motion, double part);
double free_part(const ConeMotion& first, const ConeMotion& second, double gap, const KeptGap& keeps);

}  // namespace vmesh
