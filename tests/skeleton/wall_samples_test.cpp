#include "skeleton/wall_samples.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "shapes.h"

namespace vmesh::testing {
namespace {

using skeleton::samples_by_area;
using skeleton::WallSamples;

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) all += value;
  return all;
}

TriMesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {{0, 1, 2}}}; }

TEST(WallSamples, AFaceSmallerThanTheSpacingHasOne) {
  const TriMesh mesh = icosphere(2);
  const WallSamples samples = samples_by_area(mesh, [](Index) { return 10.; });
  ASSERT_EQ(samples.points.size(), mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    EXPECT_EQ(samples.faces[f], f);
    EXPECT_LT((samples.points[f] - (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3).norm(), 1e-12);
    EXPECT_NEAR(samples.areas[f], 0.5 * area_normal(mesh, f).norm(), 1e-12);
    EXPECT_NEAR(samples.normals[f].dot(samples.points[f].normalized()), 1, 1e-2);
  }
}

TEST(WallSamples, AreasAndCentroidsAreThoseOfTheFace) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const auto point = [&] { return Vec3(5 * at(random), at(random), 0.2 * at(random)); };
    const TriMesh mesh = triangle(point(), point(), point());
    const WallSamples samples = samples_by_area(mesh, [](Index) { return 0.1; });
    EXPECT_NEAR(sum(samples.areas), 0.5 * area_normal(mesh, 0).norm(), 1e-12);
    Vec3 centroid = Vec3::Zero();
    for (std::size_t s = 0; s < samples.points.size(); ++s) centroid += samples.areas[s] * samples.points[s];
    centroid /= sum(samples.areas);
    EXPECT_LT((centroid - (mesh.vertices[0] + mesh.vertices[1] + mesh.vertices[2]) / 3).norm(), 1e-10);
    EXPECT_LE(*std::max_element(samples.areas.begin(), samples.areas.end()), 0.1 * 0.1 * 1.5);
  }
}

/// The largest distance of points of the face from a sample.
double largest_gap(const TriMesh& mesh, const WallSamples& samples) {
  double largest = 0;
  const int count = 60;
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; i + j <= count; ++j) {
      const Vec3 p = mesh.vertices[0] + double(i) / count * (mesh.vertices[1] - mesh.vertices[0]) +
                     double(j) / count * (mesh.vertices[2] - mesh.vertices[0]);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& sample : samples.points) nearest = std::min(nearest, (sample - p).norm());
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

TEST(WallSamples, NoPointOfAFaceIsFarFromOne) {
  for (const TriMesh& mesh :
       {triangle({0, 0, 0}, {4, 0, 0}, {1, 3, 0}), triangle({0, 0, 0}, {20, 0, 0}, {10, 0.5, 0}),
        triangle({0, 0, 0}, {20, 0, 0}, {20, 1, 0}), triangle({0, 0, 0}, {20, 0, 0}, {-3, 1, 0})}) {
    const WallSamples samples = samples_by_area(mesh, [](Index) { return 0.5; });
    EXPECT_LT(largest_gap(mesh, samples), 0.55);  // in the sharp corners
    // Not many more than the area needs: half a row and a column at the rim.
    EXPECT_LT(samples.points.size(), 100u);
  }
}

TEST(WallSamples, ALongTriangleHasThemAlongIt) {
  const WallSamples samples = samples_by_area(triangle({0, 0, 0}, {20, 0, 0}, {20, 0.2, 0}), [](Index) { return 0.5; });
  EXPECT_GE(samples.points.size(), 40u);
  EXPECT_LE(samples.points.size(), 42u);
  for (const double area : samples.areas) EXPECT_GT(area, 0);
}

TEST(WallSamples, FacesWithoutSpacingOrAreaHaveNone) {
  TriMesh mesh = cube();
  mesh.faces.push_back({0, 0, 1});
  mesh.faces.push_back({0, 1, 1});
  const WallSamples samples = samples_by_area(mesh, [](Index f) { return f < 2 ? 0. : 0.25; });
  EXPECT_NEAR(sum(samples.areas), 5, 1e-12);
  EXPECT_GE(*std::min_element(samples.faces.begin(), samples.faces.end()), 2u);
  EXPECT_LT(*std::max_element(samples.faces.begin(), samples.faces.end()), 12u);
}

}  // namespace
}  // namespace vmesh::testing
