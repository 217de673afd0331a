#include "vmesh/reference/reference_surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/reference/sampled_field.h"
#include "vmesh/synth/synthetic_tree.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

constexpr double kPi = 3.141592653589793;

/// Two balls of radii 6 and 3 mm as labels 1 and 2 in slices of 2.5 mm, and a hollow in the large one.
LoadedImage balls() {
  LoadedImage loaded;
  VoxelImage& image = loaded.image;
  image.size = {60, 40, 14};
  image.origin = Vec3(-10, -10, -16);
  image.steps = Vec3(0.5, 0.5, 2.5).asDiagonal();
  loaded.integer = true;
  for (std::size_t k = 0; k < image.size[2]; ++k) {
    for (std::size_t j = 0; j < image.size[1]; ++j) {
      for (std::size_t i = 0; i < image.size[0]; ++i) {
        const Vec3 p = image.position(Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
        const double first = p.norm();
        image.values.push_back(first < 6 && first > 1.5 ? 1.0f : (p - Vec3(12, 0, 0)).norm() < 4 ? 2.0f : 0.0f);
      }
    }
  }
  return loaded;
}

ReferenceOptions label(double value) {
  ReferenceOptions options;
  options.labels = {value};
  return options;
}

void expect_sound(const TriMesh& mesh, std::size_t components) {
  const Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.components, components);
}

TEST(ReferenceSurface, OfALabelHoldsThatLabel) {
  const ReferenceSurface second = reference_surface(balls(), label(2));
  expect_sound(second.mesh, 1);
  EXPECT_TRUE(second.binary);
  for (const Vec3& v : second.mesh.vertices) EXPECT_LT((v - Vec3(12, 0, 0)).norm(), 4 + 1.25);
}

TEST(ReferenceSurface, KeepsTheLargestComponentUnlessAskedForAll) {
  const ReferenceSurface largest = reference_surface(balls(), label(1));
  EXPECT_EQ(largest.components, 2u);  // the hollow has a wall of its own
  expect_sound(largest.mesh, 1);
  ReferenceOptions all = label(1);
  all.all_components = true;
  expect_sound(reference_surface(balls(), all).mesh, 2);
}

TEST(ReferenceSurface, ResampledAndSmoothedIsNearTheBall) {
  ReferenceOptions options = label(2);
  options.spacing = 0.5;
  options.smooth = 0.5;
  const ReferenceSurface surface = reference_surface(balls(), options);
  expect_sound(surface.mesh, 1);
  EXPECT_FALSE(surface.binary);
  EXPECT_LT((surface.spacing - Vec3::Constant(0.5)).norm(), 1e-9);
  // Slices of 2.5 mm say no more about a ball of 4 mm than this.
  EXPECT_NEAR(enclosed_volume(surface.mesh), 4.0 / 3 * kPi * 64, 0.15 * 268);
}

TEST(ReferenceSurface, BinaryHasNoSuchShortEdgesAsGrey) {
  ReferenceOptions options = label(2);
  options.spacing = 0.5;
  const auto shortest_edge = [&](bool binary) {
    options.binary = binary;
    const ReferenceSurface surface = reference_surface(balls(), options);
    EXPECT_EQ(surface.binary, binary);
    double shortest = 1e9;
    for (const Triangle& f : surface.mesh.faces)
      for (int c = 0; c < 3; ++c)
        shortest = std::min(shortest, (surface.mesh.vertices[f[c]] - surface.mesh.vertices[f[(c + 1) % 3]]).norm());
    return shortest;
  };
  EXPECT_GT(shortest_edge(true), 0.3);  // half of a diagonal of 0.5 mm voxels: 0.354
  EXPECT_LT(shortest_edge(false), 0.2);
}

TEST(ReferenceSurface, AsksForAChoiceAmongLabels) {
  EXPECT_THROW(reference_surface(balls()), InvalidInput);
  EXPECT_THROW(reference_surface(balls(), label(7)), InvalidInput);
  ReferenceOptions options = label(1);
  options.threshold = 0.5;
  EXPECT_THROW(reference_surface(balls(), options), InvalidInput);
  options.labels.clear();
  options.threshold = 3;
  EXPECT_THROW(reference_surface(balls(), options), InvalidInput);
  options.threshold = 0.5;
  EXPECT_NO_THROW(reference_surface(balls(), options));
  LoadedImage empty = balls();
  empty.image.values.assign(empty.image.values.size(), 0);
  EXPECT_THROW(reference_surface(empty), InvalidInput);
}

TEST(SampledField, IsTheDistanceNearTheBoundary) {
  const Centerline tree({{{0, 0, 0}, 3.0}, {{0, 0, 12}, 2}, {{6, 1, 20}, 1}}, {{0, 1}, {1, 2}});
  const double voxel = 0.4;
  const VoxelImage image = sample_field(tree, voxel);
  const VesselField field(tree);
  std::size_t near = 0;
  for (std::size_t k = 0; k < image.size[2]; ++k) {
    for (std::size_t j = 0; j < image.size[1]; ++j) {
      for (std::size_t i = 0; i < image.size[0]; ++i) {
        const double depth = -field
                                  .sample_global(image.position(
                                      Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))))
                                  .distance;
        const double value = image.at(i, j, k);
        ASSERT_NEAR(value, std::clamp(depth, -2 * voxel, 2 * voxel), 1e-6);  // stored in float
        near += std::abs(depth) < voxel ? 1 : 0;
      }
    }
  }
  EXPECT_GT(near, 1000u);
}

TEST(SampledField, OfATreeIsOneTubeOfItsVolume) {
  const Centerline straight({{{0, 0, 0}, 3.0}, {{0, 0, 20}, 3.0}}, {{0, 1}});
  const ReferenceSurface surface = reference_surface(straight, 0.25);
  expect_sound(surface.mesh, 1);
  // A cylinder with two half balls; at h = 0.25 flat faces take O(h^2 / r^2) off.
  EXPECT_NEAR(enclosed_volume(surface.mesh), kPi * 9 * 20 + 4.0 / 3 * kPi * 27, 0.005 * 678);
}

TEST(SampledField, RefusesVoxelsTooSmallOrNone) {
  const Centerline tree({{{0, 0, 0}, 3.0}, {{0, 0, 1000}, 2}}, {{0, 1}});
  EXPECT_THROW(sample_field(tree, 0), InvalidInput);
  EXPECT_THROW(sample_field(tree, std::nan("")), InvalidInput);
  EXPECT_THROW(sample_field(tree, 1e-3), InvalidInput);
}

}  // namespace
}  // namespace vmesh
