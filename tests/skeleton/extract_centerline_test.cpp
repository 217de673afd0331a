#include "vmesh/skeleton/extract_centerline.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"
#include "vmesh/mesh/components.h"
#include "vmesh/surface/generate.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/vessel_field.h"

#include "../mesh/shapes.h"
#include "axis_distance.h"

namespace vmesh::testing {
namespace {

TriMesh grown(const Centerline& centerline) { return generate_surface(centerline).mesh; }

/// For surfaces that vmesh grew.
ExtractOptions of_grown() {
  ExtractOptions options;
  options.balanced_wall = true;
  return options;
}

Centerline straight() { return {{{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.5}, {{0, 0, 40}, 2}}, {{0, 1}, {1, 2}}}; }

TEST(ExtractCenterline, OfAGrownTreeIsCloseToTheOriginal) {
  SyntheticTreeOptions options;
  options.vertices = 119;
  const Centerline tree = synthetic_tree(options);
  const ExtractedCenterline extracted = extract_centerline(grown(tree), of_grown());
  EXPECT_EQ(extracted.centerline.component_count(), 1u);
  EXPECT_EQ(extracted.centerline.cycle_rank(), 0u);
  EXPECT_EQ(end_count(extracted.centerline), end_count(tree));
  // As measured on this tree, 0.02 radii in the mean and 0.08 at 95 %, with a margin for other compilers; far below the
  // error of a grown surface with six vertices around itself (0.13 radii).
  const AxisComparison there = compare(extracted.centerline, tree), back = compare(tree, extracted.centerline);
  for (const AxisComparison& one : {there, back}) {
    EXPECT_LT(one.mean_distance, 0.04);
    EXPECT_LT(one.distance_95, 0.15);
    EXPECT_LT(one.max_distance, 0.5);
    EXPECT_LT(one.mean_radius_error, 0.015);
    EXPECT_LT(one.radius_error_95, 0.06);
  }
}

TEST(ExtractCenterline, TellsHowFarTheSurfaceIsByBranches) {
  SyntheticTreeOptions options;
  options.vertices = 40;
  const TriMesh surface = grown(synthetic_tree(options));
  const ExtractedCenterline extracted = extract_centerline(surface);
  const ExtractionReport& report = extracted.report;
  ASSERT_EQ(report.branches.size(), find_branches(extracted.centerline).size());
  EXPECT_GT(report.branches.size(), 4u);
  double area = 0, sum = 0, max = 0;
  for (const WallDistance& branch : report.branches) {
    EXPECT_LE(branch.mean, branch.max);
    EXPECT_LE(branch.percentile_95, branch.max);
    area += branch.area;
    sum += branch.area * branch.mean;
    max = std::max(max, branch.max);
  }
  // The same samples, summed in another order.
  double whole = 0;
  for (Index f = 0; f < surface.faces.size(); ++f) whole += area_normal(surface, f).norm() / 2;
  EXPECT_NEAR(area, whole, 1e-9 * area);
  EXPECT_NEAR(report.wall.area, area, 1e-9 * area);
  EXPECT_NEAR(report.wall.mean, sum / area, 1e-9);
  EXPECT_EQ(report.wall.max, max);
  const VesselField field(extracted.centerline);
  EXPECT_NEAR(std::abs(field.sample_global(report.wall.max_at).distance), max, 1e-12);
}

/// A tube around the z axis with two rings of corners only, 16 radii apart: triangles much longer than the vessel is
/// wide.
TriMesh long_prism(std::size_t sides, double radius, double length) {
  TriMesh mesh;
  const auto count = static_cast<Index>(sides);
  for (const double z : {0.0, length})
    for (Index i = 0; i < count; ++i)
      mesh.vertices.emplace_back(radius * std::cos(2 * M_PI * i / count), radius * std::sin(2 * M_PI * i / count), z);
  for (Index i = 0; i < count; ++i) {
    const Index j = (i + 1) % count;
    mesh.faces.push_back({i, j, count + j});
    mesh.faces.push_back({i, count + j, count + i});
    if (i > 0 && j > 0) {
      mesh.faces.push_back({0, j, i});
      mesh.faces.push_back({count, count + i, count + j});
    }
  }
  return mesh;
}

/// |Distance| from the centerline's volume of `count` points spread evenly over the side faces of a prism.
std::pair<double, double> true_distances(const TriMesh& prism, std::size_t sides, const Centerline& centerline) {
  const VesselField field(centerline);
  double sum = 0, most = 0;
  int count = 0;
  constexpr int kAround = 60, kAlong = 400;
  for (std::size_t side = 0; side < sides; ++side) {
    const Vec3 a = prism.vertices[side], b = prism.vertices[(side + 1) % sides];
    const double length = prism.vertices[sides].z();
    for (int i = 0; i < kAround; ++i)
      for (int j = 0; j < kAlong; ++j) {
        const Vec3 p = a + (i + 0.5) / kAround * (b - a) + Vec3(0, 0, length * (j + 0.5) / kAlong);
        const double distance = std::abs(field.sample_global(p).distance);
        sum += distance;
        most = std::max(most, distance);
        ++count;
      }
  }
  return {sum / count, most};
}

TEST(ExtractCenterline, OfLongTrianglesHasTheRadiusOfTheirVertices) {
  for (const std::size_t sides : {8u, 12u, 30u}) {
    const TriMesh prism = long_prism(sides, 5, 80);
    const ExtractedCenterline found = extract_centerline(prism);
    ASSERT_EQ(found.end_sections.size(), 2u);
    for (const CenterlineNode& node : found.centerline.nodes()) {
      EXPECT_NEAR(node.radius, 5, 0.01 * 5);  // without its fourth power, the sagitta of eight sides is .007 off
      EXPECT_LT(node.position.head<2>().norm(), 0.01 * 5);
    }
    // The report against more than fifty times as many points. The largest distance is at edges, which samples miss
    // by up to half their spacing (.1 radii) times the slope there (pi / n).
    const auto [mean, max] = true_distances(prism, sides, found.centerline);
    const double n = static_cast<double>(sides);
    EXPECT_NEAR(found.report.wall.mean, mean, 0.1 * mean + 0.002);
    EXPECT_NEAR(found.report.wall.max, max, 0.05 * 5 * M_PI / n);
  }
}

TEST(ExtractCenterline, OfABalancedWallHasTheRadiusOfItsArea) {
  for (const std::size_t sides : {8u, 12u, 30u}) {
    const ExtractedCenterline found = extract_centerline(long_prism(sides, 5, 80), of_grown());
    const double n = static_cast<double>(sides);
    const double radius = 5 * std::sqrt(n * std::sin(2 * M_PI / n) / (2 * M_PI));
    for (const CenterlineNode& node : found.centerline.nodes()) EXPECT_NEAR(node.radius, radius, 0.01 * radius);
  }
}

TEST(ExtractCenterline, OfAnOpenWallEndsInItsOpenings) {
  TriMesh open = long_prism(24, 3, 30);
  std::erase_if(open.faces, [&](const Triangle& f) {
    const auto z = [&](int i) { return open.vertices[f[static_cast<std::size_t>(i)]].z(); };
    return z(0) == z(1) && z(1) == z(2);
  });
  const ExtractedCenterline found = extract_centerline(open);
  ASSERT_EQ(found.end_sections.size(), 2u);
  for (const EndSection& section : found.end_sections) {
    EXPECT_TRUE(section.open);
    EXPECT_EQ(section.ring.size(), 24u);
    EXPECT_EQ(found.centerline.degree(section.node), 1u);
    EXPECT_LT((found.centerline.node(section.node).position - section.center).norm(), 1e-6);
  }
  EXPECT_GT(found.report.coverage, 0.999);
}

TEST(ExtractCenterline, EndsDoNotStickOut) {
  const Centerline tube = straight();
  const Centerline found = extract_centerline(grown(tube), of_grown()).centerline;
  for (Index n = 0; n < found.nodes().size(); ++n) {
    const CenterlineNode& node = found.node(n);
    const double low = node.position.z() - node.radius, high = node.position.z() + node.radius;
    EXPECT_GT(low, -3.0 - 0.1 * 3);  // the surface's own ends: -3 and 42
    EXPECT_LT(high, 42.0 + 0.1 * 2);
    EXPECT_LT(node.radius, 3.0 * 1.05);
  }
}

TEST(ExtractCenterline, OfATorusIsALoopUnlessATreeIsWanted) {
  const TriMesh ring = torus(10, 2, 60, 20);
  const Centerline loop = extract_centerline(ring).centerline;
  EXPECT_EQ(loop.component_count(), 1u);
  EXPECT_EQ(loop.cycle_rank(), 1u);
  for (const CenterlineNode& node : loop.nodes()) {
    EXPECT_NEAR(node.radius, 2, 0.1);
    EXPECT_NEAR(node.position.head<2>().norm(), 10, 0.2);
  }
  ExtractOptions tree;
  tree.tree = true;
  const ExtractedCenterline broken = extract_centerline(ring, tree);
  EXPECT_EQ(broken.centerline.cycle_rank(), 0u);
  ASSERT_EQ(broken.report.loops.size(), 1u);
  EXPECT_TRUE(broken.report.loops[0].opened);
}

TEST(ExtractCenterline, OfABallIsSmall) {
  TriMesh ball = icosphere(4);
  for (Vec3& v : ball.vertices) v *= 5;
  const Centerline centerline = extract_centerline(ball).centerline;
  EXPECT_EQ(centerline.cycle_rank(), 0u);
  for (const CenterlineNode& node : centerline.nodes()) EXPECT_LT(node.position.norm() + node.radius, 5.5);
}

TEST(ExtractCenterline, SpacingIsInRadii) {
  const TriMesh tube = grown(straight());
  ExtractOptions coarse, fine;
  coarse.spacing = 2;
  fine.spacing = 0.5;
  const std::size_t few = extract_centerline(tube, coarse).centerline.nodes().size();
  const std::size_t many = extract_centerline(tube, fine).centerline.nodes().size();
  EXPECT_NEAR(static_cast<double>(many - 1), 4.0 * static_cast<double>(few - 1), 6);
}

TEST(ExtractCenterline, JoinsEndsThatPointAtEachOtherAndKeepsTheRest) {
  const TriMesh first = grown(straight());
  const TriMesh near = moved(first, Vec3(0, 0, 46)), far = moved(first, Vec3(0, 40, 0));
  const ExtractedCenterline pair = extract_centerline(first + near, of_grown());
  EXPECT_EQ(pair.centerline.component_count(), 1u);
  ASSERT_EQ(pair.report.joined.size(), 1u);
  // The surfaces are 1 mm apart, at z = 42 and 43.
  EXPECT_NEAR(pair.report.joined[0].gap, 1, 0.2);
  EXPECT_EQ(pair.report.left_out, 0u);
  EXPECT_EQ(extract_centerline(first + near + far).centerline.component_count(), 2u);
  ExtractOptions options;
  options.join = 0;
  EXPECT_EQ(extract_centerline(first + near + far, options).centerline.component_count(), 3u);
  options.largest = true;
  const ExtractedCenterline one = extract_centerline(first + near + far, options);
  EXPECT_EQ(one.centerline.component_count(), 1u);
  EXPECT_EQ(one.report.left_out, 2u);
  EXPECT_LT(one.report.coverage, 0.4);
}

TEST(ExtractCenterline, LeavesCavitiesOut) {
  TriMesh small = icosphere(2);
  const TriMesh hollow = grown(straight()) + moved(inverted(small), Vec3(0, 0, 20));
  const ExtractedCenterline found = extract_centerline(hollow);
  EXPECT_EQ(found.report.components, 1u);
  EXPECT_FALSE(found.report.notes.empty());
  EXPECT_EQ(found.centerline.component_count(), 1u);
}

TEST(ExtractCenterline, TurnsASurfaceThatFacesInwards) {
  const TriMesh tube = grown(straight());
  EXPECT_EQ(extract_centerline(inverted(tube)).centerline.component_count(), 1u);
}

TEST(ExtractCenterline, HasTheSameResultWheneverItRuns) {
  const TriMesh tube = grown(straight());
  const Centerline first = extract_centerline(tube).centerline;
  // The same work at other addresses.
  std::vector<std::vector<int>> between;
  for (int i = 0; i < 1000; ++i) between.emplace_back(static_cast<std::size_t>(1 + 37 * i % 991));
  for (std::size_t i = 0; i < between.size(); i += 2) between[i] = {};
  const Centerline second = extract_centerline(tube).centerline;
  ASSERT_EQ(first.nodes().size(), second.nodes().size());
  for (Index n = 0; n < first.nodes().size(); ++n) {
    EXPECT_EQ(first.node(n).position, second.node(n).position);
    EXPECT_EQ(first.node(n).radius, second.node(n).radius);
  }
}

TEST(ExtractCenterline, RefusesWhatHasNoInside) {
  EXPECT_THROW(extract_centerline(TriMesh()), InvalidInput);
  TriMesh flat = icosphere(1);
  for (Vec3& v : flat.vertices) v.z() = 0;
  EXPECT_THROW(extract_centerline(flat), InvalidInput);
  ExtractOptions options;
  options.spacing = 0;
  EXPECT_THROW(extract_centerline(icosphere(2), options), InvalidInput);
  options.spacing = 1;
  options.join = std::nan("");
  EXPECT_THROW(extract_centerline(icosphere(2), options), InvalidInput);
}

TEST(ExtractCenterline, CanBeCancelled) {
  EXPECT_THROW(extract_centerline(icosphere(2), {}, [](std::string_view, double) { return false; }), Cancelled);
}

TEST(ExtractCenterline, CanBeCancelledWithinAPart) {
  int calls = 0;
  EXPECT_THROW(extract_centerline(icosphere(2), {}, [&](std::string_view, double) { return ++calls < 3; }), Cancelled);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace vmesh::testing
