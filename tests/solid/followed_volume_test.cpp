#include <gtest/gtest.h>

#include "vmesh/surface/followed_surface.h"

#include "vessels.h"

namespace vmesh {
namespace {

using namespace testing;

TEST(FollowedVolume, OnOneVesselKeepsItsShareOfTheRadius) {
  const Centerline tube = testing::tube();
  const std::vector<Vec3> points = {{10, 0, 0}, {10, 1, 0}, {10, 0, -2}, {3, 1, 1}, {0, 2, 0}};
  CenterlineEdit edit;
  edit.radius = {{1, 30, -0.5}};  // about the end at x = 20
  edit.scale = 2;
  const std::vector<Vec3> moved = follow_edit_within(points, tube, edit);
  const ChangedRadius radius(tube, edit.radius);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double factor = radius.factor(0, points[i].x() / 20);
    const Vec3 expected(2 * points[i].x(), 2 * factor * points[i].y(), 2 * factor * points[i].z());
    EXPECT_LT((moved[i] - expected).norm(), 1e-12) << i;
  }
}

TEST(FollowedVolume, IsNotTornBetweenBranches) {
  const Centerline centerline = bifurcation();
  CenterlineEdit edit;
  edit.radius = {{1, 12, 0.5}};
  // Across the plane x = 0, which is as far from one branch as from the other but for their radii.
  constexpr double kApart = 1e-6;
  for (double z = 14; z < 24; z += 0.05) {
    for (double x = -1.5; x < 1.5; x += 0.05) {
      const std::vector<Vec3> moved = follow_edit_within({{x, 0.3, z}, {x + kApart, 0.3, z}}, centerline, edit);
      // Continuous: stretched by no more than a few times, where a jump would be by thousands of times.
      EXPECT_LT((moved[1] - moved[0]).norm(), 20 * kApart) << x << " " << z;
    }
  }
}

}  // namespace
}  // namespace vmesh
