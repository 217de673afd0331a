#include "vmesh/comparison/method_comparison.h"

#include <gtest/gtest.h>

#include "vmesh/comparison/paper_table.h"
#include "vmesh/core/error.h"
#include "vmesh/surface/generate.h"

namespace vmesh {
namespace {

Centerline y_tree() {
  return {{{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.8}, {{-9, 0, 32}, 2.1}, {{8, 3, 33}, 2.3}}, {{0, 1}, {1, 2}, {3, 1}}};
}

/// In place of marching cubes: many small triangles on the plain union of the cones.
TriMesh fine_surface() {
  GenerateOptions options;
  options.around = 30;
  options.blend = 0;
  return generate_surface(y_tree(), options).mesh;
}

class ComparedMethods : public ::testing::Test {
 protected:
  static const MethodComparison& comparison() {
    static const MethodComparison result = compare_methods(fine_surface(), y_tree());
    return result;
  }
};

TEST_F(ComparedMethods, ComeInTheOrderOfThePaper) {
  for (std::size_t i = 0; i < comparison().rows.size(); ++i)
    EXPECT_EQ(comparison().rows[i].method, static_cast<SurfaceMethod>(i));
  EXPECT_EQ(to_string(comparison().rows[1].method), "truncated cones");
  EXPECT_EQ(comparison().row(SurfaceMethod::truncated_cones).mesh.vertices.size(), 3u * 37);
  EXPECT_EQ(comparison().row(SurfaceMethod::marching_cubes).mesh.faces, fine_surface().faces);
}

TEST_F(ComparedMethods, HaveTheSurfacesOfThePresets) {
  ASSERT_EQ(comparison().rows.size(), 6u);  // the cones have too few vertices for the presets to stay below
  for (const auto& [method, preset] :
       {std::pair{SurfaceMethod::low_preset, Preset::low}, std::pair{SurfaceMethod::high_preset, Preset::high}}) {
    GenerateOptions options;
    options.around = vertices_around(preset);
    const TriMesh expected = generate_surface(y_tree(), options).mesh;
    EXPECT_EQ(comparison().row(method).around, options.around);
    EXPECT_EQ(comparison().row(method).mesh.vertices, expected.vertices);
    EXPECT_EQ(comparison().row(method).mesh.faces, expected.faces);
  }
}

Centerline straight_vessel(Index nodes, double spacing, double radius) {
  std::vector<CenterlineNode> places;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < nodes; ++i) {
    places.push_back({{0, 0, spacing * i}, radius});
    if (i > 0) segments.push_back({i - 1, i});
  }
  return {std::move(places), std::move(segments)};
}

MethodComparison compared_with_fine_surface(const Centerline& vessel) {
  GenerateOptions fine;
  fine.around = 40;
  MethodOptions options;
  options.samples = 1000;
  return compare_methods(generate_surface(vessel, fine).mesh, vessel, options);
}

TEST(ComparedResolutions, ArePresetsWhereThesePassForThePapers) {
  const MethodComparison comparison = compared_with_fine_surface(straight_vessel(100, 0.3, 2));  // many cones
  ASSERT_EQ(comparison.rows.size(), 4u);
  EXPECT_EQ(comparison.row(SurfaceMethod::low_resolution).around, 6);
  EXPECT_EQ(comparison.row(SurfaceMethod::high_resolution).around, 12);
}

TEST(ComparedResolutions, AreTheFinestWithNoLargerShareThanInThePaper) {
  const Centerline vessel = straight_vessel(21, 2, 1);
  const MethodComparison comparison = compared_with_fine_surface(vessel);
  const double cones = 20 * 37;
  for (const auto method : {SurfaceMethod::low_resolution, SurfaceMethod::high_resolution}) {
    const MethodRow& row = comparison.row(method);
    const double most = cones * static_cast<double>(paper_row(method).vertices) /
                        static_cast<double>(paper_row(SurfaceMethod::truncated_cones).vertices);
    EXPECT_LE(static_cast<double>(row.mesh.vertices.size()), most);
    GenerateOptions finer;
    finer.around = row.around + 1;
    finer.max_center_distance = 1;
    EXPECT_GT(static_cast<double>(generate_surface(vessel, finer).mesh.vertices.size()), most);
  }
}

TEST_F(ComparedMethods, AreMeasuredAgainstTheReferenceBothWays) {
  EXPECT_FALSE(comparison().row(SurfaceMethod::marching_cubes).distance);
  const TriMesh reference = fine_surface();
  for (const MethodRow& row : comparison().rows) {
    EXPECT_EQ(row.soundness.has_value(), row.around > 0);
    EXPECT_TRUE(!row.soundness || (row.soundness->topology.closed && row.soundness->topology.manifold));
    EXPECT_EQ(row.skewness.max, summarize_skewness(row.mesh).max);
    if (row.method == SurfaceMethod::marching_cubes) continue;
    ASSERT_TRUE(row.distance);
    const auto& [hausdorff, from_surface, from_reference] = *row.distance;
    EXPECT_LE(hausdorff.upper() - hausdorff.lower(), 1e-4);
    EXPECT_LE(from_surface.distance.max, hausdorff.forward.upper);
    EXPECT_LE(from_reference.distance.max, hausdorff.backward.upper);
    // Directions are not swapped: from the surface, the witness is a point of one of its faces.
    EXPECT_LT(hausdorff.forward.witness.from_face, row.mesh.faces.size());
    EXPECT_NEAR(from_surface.samples_per_mm2, 100'000 / surface_area(row.mesh), 1e-6);
    EXPECT_NEAR(from_reference.samples_per_mm2, 100'000 / surface_area(reference), 1e-6);
  }
}

TEST_F(ComparedMethods, GrowCloserWithMoreTriangles) {
  const auto mean = [](SurfaceMethod method) {
    return comparison().row(method).distance->from_reference.distance.mean;
  };
  EXPECT_LT(mean(SurfaceMethod::high_preset), mean(SurfaceMethod::low_preset));
  // A cone ends flat in the middle of a ball of 3 mm, so that the root's tip is as far from it.
  const OneSidedHausdorff cones = comparison().row(SurfaceMethod::truncated_cones).distance->hausdorff.backward;
  EXPECT_NEAR(cones.upper, 3, 0.05);
}

TEST_F(ComparedMethods, AreTheSameEveryTime) {
  const MethodComparison again = compare_methods(fine_surface(), y_tree());
  ASSERT_EQ(again.rows.size(), comparison().rows.size());
  for (std::size_t i = 0; i < again.rows.size(); ++i) {
    const MethodRow &a = comparison().rows[i], &b = again.rows[i];
    EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
    EXPECT_EQ(a.skewness.mean, b.skewness.mean);
    if (!a.distance) continue;
    EXPECT_EQ(a.distance->hausdorff.lower(), b.distance->hausdorff.lower());
    EXPECT_EQ(a.distance->from_reference.distance.rms, b.distance->from_reference.distance.rms);
  }
}

TEST_F(ComparedMethods, AreCountedAndMeasuredAsAsked) {
  MethodOptions options;
  options.sides = 5;
  options.tolerance = 0.1;
  options.samples = 100;
  const MethodRow cones = compare_methods(fine_surface(), y_tree(), options).row(SurfaceMethod::truncated_cones);
  EXPECT_EQ(cones.mesh.vertices.size(), 3u * 11);
  EXPECT_EQ(cones.distance->from_reference.distance.count, 100u);
  EXPECT_LE(cones.distance->hausdorff.upper() - cones.distance->hausdorff.lower(), 0.1);
}

TEST(CompareMethods, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(compare_methods({}, y_tree()), InvalidInput);
  EXPECT_THROW(compare_methods(fine_surface(), Centerline({{{0, 0, 0}, 1}}, {})), InvalidInput);
  EXPECT_THROW(compare_methods(fine_surface(), y_tree(), {2}), InvalidInput);
  EXPECT_THROW(compare_methods(fine_surface(), y_tree(), {}, [](auto, double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace vmesh
