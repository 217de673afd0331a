#include "vmesh/image/contour.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "vmesh/core/disjoint_sets.h"
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

VoxelImage image_of(std::size_t nx, std::size_t ny, std::size_t nz, std::vector<float> values) {
  VoxelImage image;
  image.size = {nx, ny, nz};
  image.values = std::move(values);
  return image;
}

/// `value(random)` at n^3 voxels.
template <class Value>
VoxelImage noise(std::size_t n, Value value, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(n * n * n);
  for (float& v : values) v = static_cast<float>(value(random));
  return image_of(n, n, n, std::move(values));
}

VoxelImage binary_noise(std::size_t n, unsigned seed) {
  return noise(
      n, [](auto& random) { return random() % 2; }, seed);
}

/// Of both signs and many magnitudes.
VoxelImage grey_noise(std::size_t n, unsigned seed) {
  return noise(
      n,
      [](auto& random) {
        const double u = std::uniform_real_distribution<double>(-1, 1)(random);
        return u * u * u;
      },
      seed);
}

Topology expect_manifold(const TriMesh& mesh) {
  const Topology topology = measure_topology(mesh);
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_GT(enclosed_volume(mesh), 0);
  return topology;
}

TEST(Contour, OfNoiseIsManifold) {
  expect_manifold(contour(binary_noise(24, 1), 0.5));
  expect_manifold(contour(grey_noise(24, 2), 0));
  expect_manifold(contour(noise(
                              24, [](auto& random) { return static_cast<int>(random() % 5) - 2; }, 3),
                          0));
}

TEST(Contour, OfNoiseDoesNotCrossItself) { EXPECT_TRUE(self_intersections(contour(binary_noise(20, 4), 0.5)).empty()); }

TEST(Contour, OfEveryCellIsManifold) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> magnitude(0.01f, 1);
  for (int round = 0; round < 40; ++round) {
    // Cells of all patterns in a row, with two voxels outside between them.
    VoxelImage cells = image_of(4 * 256, 2, 2, std::vector<float>(4 * 256 * 4, -1));
    for (std::size_t n = 0; n < 256 * 8; ++n) {
      const std::size_t pattern = n / 8, c = n % 8;
      const float value = std::pow(magnitude(random), static_cast<float>(1 + round % 3));
      cells.values[cells.offset(4 * pattern + (c & 1), c >> 1 & 1, c >> 2)] = (pattern >> c & 1) != 0 ? value : -value;
    }
    const TriMesh mesh = contour(cells, 0);
    EXPECT_TRUE(expect_manifold(mesh).outward);  // there is no room for a cavity
    const Eigen::AlignedBox3d box(Vec3(-1, -1, -1), Vec3(1024, 2, 2));
    for (const Vec3& v : mesh.vertices) EXPECT_TRUE(box.contains(v));
  }
}

/// The axes in another order.
VoxelImage turned(const VoxelImage& image) {
  VoxelImage result = image_of(image.size[1], image.size[2], image.size[0], {});
  for (std::size_t k = 0; k < result.size[2]; ++k)
    for (std::size_t j = 0; j < result.size[1]; ++j)
      for (std::size_t i = 0; i < result.size[0]; ++i) result.values.push_back(image.at(k, i, j));
  return result;
}

TEST(Contour, HasTheSameTopologyAlongWhateverAxes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    VoxelImage image = grey_noise(12, seed);
    const Topology before = measure_topology(contour(image, 0));
    for (int turn = 0; turn < 2; ++turn) {
      image = turned(image);
      const Topology after = measure_topology(contour(image, 0));
      EXPECT_EQ(after.components, before.components);
      EXPECT_EQ(after.genus, before.genus);
    }
  }
}

TEST(Contour, ConnectsOppositeCornersOfAFaceAsTheBilinearInterpolantDoes) {
  // At the saddle it is (a c - b d) / (a + c - b - d).
  const auto parts = [](float a, float b, float c, float d) {
    return expect_manifold(contour(image_of(2, 2, 1, {a, b, d, c}), 0)).components;
  };
  EXPECT_EQ(parts(1.1f, -1, 1, -1), 1u);
  EXPECT_EQ(parts(0.9f, -1, 1, -1), 2u);
  EXPECT_EQ(parts(1, -1, 1, -1), 2u);
  EXPECT_EQ(parts(-1, 2, -2, 1.1f), 1u);
}

TEST(Contour, ConnectsOppositeCornersOfACellAsTheTrilinearInterpolantDoes) {
  // With v at two opposite corners and -1 at the others, what connects them at z = 1/2 is (v - 1)^2 / 4 - 1: v > 3.
  const auto cell = [](float v, float other) {
    return image_of(2, 2, 2, {v, other, other, other, other, other, other, v});
  };
  expect_sound(contour(cell(2.9f, -1), 0), 0, 2);
  expect_sound(contour(cell(3.1f, -1), 0), 0, 1);
  // A hole through what is inside.
  expect_sound(contour(cell(-2.9f, 1), 0), 0, 1);
  expect_sound(contour(cell(-3.1f, 1), 0), 1, 1);
}

TEST(Contour, ConnectsOppositeEdgesOfACellAsTheTrilinearInterpolantDoes) {
  // Edges along x at (0, 0) and (1, 1), inside; their values change from a to b and from b to a. They are connected at
  // the ends if a b > 1, in the middle if (a + b) / 2 > 1.
  const auto parts = [](float a, float b) {
    const TriMesh mesh = contour(image_of(2, 2, 2, {a, b, -1, -1, -1, -1, b, a}), 0);
    EXPECT_TRUE(self_intersections(mesh).empty());
    return expect_manifold(mesh).components;
  };
  EXPECT_EQ(parts(0.3f, 1.6f), 2u);
  EXPECT_EQ(parts(0.5f, 1.9f), 1u);
  EXPECT_EQ(parts(0.9f, 1.9f), 1u);
}

/// Parts of the image, with a border outside, whose voxels have a common face (inside) or corner (outside).
std::size_t parts_of_mask(const VoxelImage& mask) {
  const std::array<std::ptrdiff_t, 3> n = {static_cast<std::ptrdiff_t>(mask.size[0]) + 2,
                                           static_cast<std::ptrdiff_t>(mask.size[1]) + 2,
                                           static_cast<std::ptrdiff_t>(mask.size[2]) + 2};
  const auto inside = [&](std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) {
    return i > 0 && j > 0 && k > 0 && i < n[0] - 1 && j < n[1] - 1 && k < n[2] - 1 && mask.at(i - 1, j - 1, k - 1) > 0;
  };
  const auto number = [&](std::ptrdiff_t i, std::ptrdiff_t j, std::ptrdiff_t k) {
    return static_cast<Index>((k * n[1] + j) * n[0] + i);
  };
  DisjointSets sets(static_cast<std::size_t>(n[0] * n[1] * n[2]));
  std::size_t parts = static_cast<std::size_t>(n[0] * n[1] * n[2]);
  for (std::ptrdiff_t at = 0; at < n[0] * n[1] * n[2] * 27; ++at) {
    const std::ptrdiff_t voxel = at / 27, i = voxel % n[0], j = voxel / n[0] % n[1], k = voxel / (n[0] * n[1]);
    const std::ptrdiff_t di = at % 3 - 1, dj = at / 3 % 3 - 1, dk = at / 9 % 3 - 1;
    if (i + di < 0 || j + dj < 0 || k + dk < 0 || i + di >= n[0] || j + dj >= n[1] || k + dk >= n[2]) continue;
    if (inside(i, j, k) != inside(i + di, j + dj, k + dk)) continue;
    if (inside(i, j, k) && std::abs(di) + std::abs(dj) + std::abs(dk) > 1) continue;
    if (sets.join(number(i, j, k), number(i + di, j + dj, k + dk))) --parts;
  }
  return parts;
}

TEST(Contour, OfAMaskSeparatesWhatHasNoCommonFace) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const VoxelImage mask = binary_noise(9, seed);
    // A closed surface without self-contact parts space into one part more than it has components.
    EXPECT_EQ(expect_manifold(contour(mask, 0.5)).components + 1, parts_of_mask(mask));
  }
}

TEST(Contour, IsTheSameWithAnyNumberOfThreads) {
  const VoxelImage image = grey_noise(40, 6);
  const TriMesh several = contour(image, 0.1);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TriMesh alone = contour(image, 0.1);
  EXPECT_EQ(alone.vertices, several.vertices);
  EXPECT_EQ(alone.faces, several.faces);
}

TEST(Contour, OfRowsOfAnyLengthIsClosed) {
  // Bits of samples are in words of 64.
  for (const std::size_t length : {1, 60, 61, 62, 63, 64, 65, 126, 127, 190}) {
    expect_sound(contour(image_of(length, 1, 1, std::vector<float>(length, 1)), 0.5), 0);
    std::vector<float> ends(length, 0);
    ends.front() = ends.back() = 1;
    expect_sound(contour(image_of(length, 1, 1, ends), 0.5), 0, length > 1 ? 2 : 1);
  }
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
