#include "vmesh/image/contour.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/image/image_filters.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"

#include "image_files.h"

namespace vmesh::testing {
namespace {

/// An image of `values(p)` at positions p on n^3 voxels that cover [-10, 10]^3.
template <class Function>
VoxelImage sampled(int n, Function values) {
  VoxelImage image;
  image.size = {static_cast<std::size_t>(n), static_cast<std::size_t>(n), static_cast<std::size_t>(n)};
  image.steps *= 20.0 / (n - 1);
  image.origin = Vec3::Constant(-10);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) image.values.push_back(static_cast<float>(values(image.position(Vec3(i, j, k)))));
  return image;
}

void expect_sound(const TriMesh& mesh, std::int64_t genus, std::size_t components = 1) {
  const Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.genus, genus);
  EXPECT_EQ(topology.components, components);
}

TEST(Contour, OfASphereHasItsVolumeAndTopology) {
  const double radius = 7;
  const TriMesh mesh = contour(sampled(41, [&](const Vec3& p) { return radius - p.norm(); }), 0);
  expect_sound(mesh, 0);
  // Linear interpolation of the distance and flat faces each take O(h^2 / r^2) off: h = 0.5.
  EXPECT_NEAR(enclosed_volume(mesh), 4.0 / 3 * std::numbers::pi * std::pow(radius, 3), 0.01 * 1437);
  for (const Vec3& v : mesh.vertices) EXPECT_NEAR(v.norm(), radius, 0.02);
}

TEST(Contour, OfACylinderAcrossTheImageIsClosedAtItsBorder) {
  const double radius = 3;
  const TriMesh mesh = contour(sampled(41, [&](const Vec3& p) { return radius - p.head<2>().norm(); }), 0);
  expect_sound(mesh, 0);
  // It ends up to a voxel (h = 0.5) beyond the first and last slice; flat faces cut O(h^2 / r^2) off.
  const double area = std::numbers::pi * radius * radius;
  EXPECT_GT(enclosed_volume(mesh), 0.99 * 20 * area);
  EXPECT_LT(enclosed_volume(mesh), 21 * area);
}

TEST(Contour, OfATorusHasAHole) {
  const auto depth = [](const Vec3& p) { return 2.0 - Vec3(p.head<2>().norm() - 6, p.z(), 0).norm(); };
  const TriMesh mesh = contour(sampled(41, depth), 0);
  expect_sound(mesh, 1);
  EXPECT_NEAR(enclosed_volume(mesh), 2 * std::numbers::pi * std::numbers::pi * 6 * 4, 0.02 * 474);
}

TEST(Contour, OfAMaskIsAsEvenAsBinaryContoursAre) {
  const VoxelImage mask = sampled(41, [](const Vec3& p) { return p.norm() < 7 ? 1 : 0; });
  const TriMesh mesh = contour(mask, 0.5);
  expect_sound(mesh, 0);
  double voxels = 0;
  for (const float value : mask.values) voxels += value;
  EXPECT_NEAR(enclosed_volume(mesh), voxels * std::pow(0.5, 3), 0.02 * 1437);
  EXPECT_LT(summarize_skewness(mesh).max, 0.51);  // 0.5 up to rounding: right-angled triangles at worst
}

TEST(Contour, LandsWhereTheImageLies) {
  SampleImage place;
  for (const double handed : {1.0, -1.0}) {
    VoxelImage image = sampled(21, [](const Vec3& p) { return 6 - p.norm(); });
    image.origin = place.origin;
    image.steps = place.direction * place.spacing.asDiagonal();
    image.steps.col(0) *= handed;
    const TriMesh mesh = contour(image, 0);
    expect_sound(mesh, 0);
    Vec3 mean = Vec3::Zero();
    for (const Vec3& v : mesh.vertices) mean += v / static_cast<double>(mesh.vertices.size());
    EXPECT_LT((mean - image.position(Vec3::Constant(10))).norm(), 0.05);
    EXPECT_NEAR(enclosed_volume(mesh), 4.0 / 3 * std::numbers::pi * 216 * place.spacing.prod(), 0.02 * 2120);
  }
}

TEST(Contour, HasNoCoincidentVerticesWhereValuesAreExactlyTheIsovalue) {
  const VoxelImage image = sampled(21, [](const Vec3& p) { return 5 - p.lpNorm<Eigen::Infinity>(); });
  const TriMesh mesh = contour(image, 0);
  expect_sound(mesh, 0);
  EXPECT_TRUE(self_intersections(mesh).empty());
  for (const Triangle& f : mesh.faces)
    for (int c = 0; c < 3; ++c) EXPECT_GT((mesh.vertices[f[c]] - mesh.vertices[f[(c + 1) % 3]]).norm(), 1e-4);
}

TEST(Contour, OfAmbiguousCellsIsManifold) {
  std::uint32_t state = 12345;
  const VoxelImage noise = sampled(24, [&](const Vec3&) {
    state = state * 1664525u + 1013904223u;
    return (state >> 16) % 2;
  });
  const Topology topology = measure_topology(contour(noise, 0.5));
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
}

TEST(Contour, OfNothingIsRefused) {
  EXPECT_THROW(contour(sampled(5, [](const Vec3&) { return 0; }), 0.5), InvalidInput);
  EXPECT_THROW(contour(VoxelImage(), 0.5), InvalidInput);
}

TEST(Contour, OfAFullImageIsItsBox) {
  const TriMesh mesh = contour(sampled(5, [](const Vec3&) { return 3; }), 0.5);
  expect_sound(mesh, 0);
}

}  // namespace
}  // namespace vmesh::testing
