// Walls of real vessels, with the figures that were asked for.
#include <gtest/gtest.h>

#include "vmesh/fit/fit_surface.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/skeleton/extract_centerline.h"
#include "vmesh/volume/contacts.h"

#include "shared_data.h"

namespace vmesh {
namespace {

struct Demand {
  double mean, p95, hausdorff;  // mm
};

void expect_fitted(const std::string& file, const Demand& demand) {
  const TriMesh reference = read_surface(testing::shared_data(file)).mesh;
  const Centerline centerline = separate_contacts(extract_centerline(reference).centerline).centerline;
  GenerateResult result = generate_surface(centerline);
  ASSERT_TRUE(result.is_sound());
  const auto before = static_cast<double>(result.mesh.vertices.size());
  const FitReport report = fit_surface(result, centerline, reference);
  EXPECT_TRUE(result.is_sound());
  EXPECT_LE(static_cast<double>(result.mesh.vertices.size()), 1.05 * before);
  EXPECT_LE(report.after.mean(), demand.mean);
  EXPECT_LE(report.after.p95(), demand.p95);
  EXPECT_LE(report.after.hausdorff.upper(), demand.hausdorff);
  const SkewnessSummary skewness = summarize_skewness(result.mesh);
  EXPECT_LE(skewness.mean, 0.14);
  EXPECT_LT(skewness.max, 0.5);
}

TEST(FitRealSurfaces, PulmonaryArteries) {
  const char* const file = "pairs_centerline_surface/generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp";
  VMESH_NEED_SHARED_DATA(file);
  expect_fitted(file, {0.035, 0.09, 0.35});
}

TEST(FitRealSurfaces, Aorta) {
  const char* const file = "pairs_centerline_surface/aorta-surface.stl";
  VMESH_NEED_SHARED_DATA(file);
  expect_fitted(file, {0.19, 0.49, 1.0});
}

}  // namespace
}  // namespace vmesh
