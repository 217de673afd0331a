// Even surfaces that meet a limit on the error; that they do is measured in max_error_test.cpp.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

#include "centerlines.h"
#include "surface/proof/by_slope.h"

namespace vmesh {
namespace {

GenerateOptions within(double relative, double blend) {
  GenerateOptions options;
  options.max_error.relative = relative;
  options.blend = blend;
  return options;
}

// The plain union of a fork's vessels has creases, on which two of them have their boundary.
TEST(Refinement, HasVerticesAndEdgesOnCreases) {
  const Centerline centerline = testing::fork();
  const GenerateResult result = generate_surface(centerline, within(0.02, 0));
  EXPECT_TRUE(result.is_sound());
  EXPECT_EQ(result.error.unproven_faces, 0u);
  const VesselField field(centerline, 0);
  // The daughters' first segments.
  const auto is_on_crease = [&](const Vec3& p, double tolerance) {
    return std::abs(field.sample_cone(p, 1).distance) < tolerance &&
           std::abs(field.sample_cone(p, 3).distance) < tolerance;
  };
  std::size_t vertices = 0, edges = 0;
  for (const Vec3& p : result.mesh.vertices) vertices += is_on_crease(p, 1e-3);
  for (const Triangle& f : result.mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = result.mesh.vertices[f[k]], &b = result.mesh.vertices[f[(k + 1) % 3]];
      // The middle of an edge on a curve is as far from it as the limit allows.
      edges +=
          f[k] < f[(k + 1) % 3] && is_on_crease(a, 1e-3) && is_on_crease(b, 1e-3) && is_on_crease((a + b) / 2, 0.02);
    }
  }
  EXPECT_GE(vertices, 6u);
  EXPECT_GE(edges, 5u);
}

TEST(Refinement, KeepsOpenEnds) {
  GenerateOptions options = within(0.03, 0.5);
  options.open_ends.nodes = {0, 3};
  const GenerateResult result = generate_surface(testing::fork(), options);
  EXPECT_TRUE(result.is_sound());
  ASSERT_EQ(result.openings.size(), 2u);
  // The surface ends there, and the boundary does not.
  for (const UnprovenPlace& place : result.error.unproven_places) {
    EXPECT_TRUE(std::any_of(result.openings.begin(), result.openings.end(), [&](const Opening& opening) {
      return (place.position - opening.center).norm() < 2 * opening.radius;
    }));
  }
}

TEST(Refinement, LeavesInscribedVerticesOnTheBoundary) {
  GenerateOptions options = within(0.03, 0.5);
  options.placement = Placement::inscribed;
  const Centerline centerline = testing::fork();
  const GenerateResult result = generate_surface(centerline, options);
  EXPECT_EQ(result.error.unproven_faces, 0u);
  const VesselField field(centerline, 0.5);
  double farthest = 0;
  for (Index v = 0; v < result.mesh.vertices.size(); ++v)
    farthest = std::max(farthest, std::abs(field.sample_global(result.mesh.vertices[v]).distance) / result.radius[v]);
  // Vertices are projected to .001 radii, and mended by a little more.
  EXPECT_LT(farthest, 0.01);
}

TEST(Refinement, DoesNotDependOnTheNumberOfThreads) {
  GenerateOptions options = within(0.02, 0);
  options.threads = 1;
  const GenerateResult one = generate_surface(testing::fork(50), options);
  options.threads = 3;
  const GenerateResult three = generate_surface(testing::fork(50), options);
  EXPECT_EQ(one.mesh.vertices, three.mesh.vertices);
  EXPECT_EQ(one.mesh.faces, three.mesh.faces);
}

// In the gap between two vessels that part at eight degrees and are blended, above where it ends.
TEST(Refinement, TellsTheDistanceWhereTheFieldHasHardlyASlope) {
  const double half = 4 * std::numbers::pi / 180;
  const Vec3 up(40 * std::sin(half), 0, 40 * std::cos(half)), down(-up.x(), 0, up.z());
  const Centerline centerline{{{{0, 0, 0}, 1}, {up, 1}, {down, 1}}, {{0, 1}, {0, 2}}};
  const VesselField field(centerline, 0.5);
  const auto at = [&](double z) { return field.sample_global({0, 0, z}); };
  double end = 10;  // of the gap, on the way between the vessels
  while (at(end).distance < 0) end += 1e-3;
  const Vec3 above(0, 0, end + 0.3);
  const FieldSample sample = field.sample_global(above);
  // The field is a distance: it changes by no more than its argument.
  ASSERT_LT(sample.distance, 0.5 * 0.3);
  // Slopes change on the way there, by less than their half.
  EXPECT_NEAR(distance_by_slope(sample), 0.3, 0.15);
  const BoundaryPoint there = onto_boundary(field, above, sample.cone, 1e-3, 0);
  EXPECT_NEAR(there.position.z(), end, 4e-3);  // steps of the search, and the tolerance by slope in single precision
}

}  // namespace
}  // namespace vmesh
