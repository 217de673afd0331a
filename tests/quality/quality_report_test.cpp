#include "vmesh/quality/quality_report.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

#include "soups.h"

namespace vmesh {
namespace {

using testing::operator+;

TEST(Distribution, InterpolatesBetweenRanks) {
  std::vector<double> values(101);
  std::iota(values.begin(), values.end(), 0.0);
  testing::Draw draw(1);
  draw.shuffle(values);
  const Distribution d = summarize(values);
  EXPECT_EQ(d.count, 101u);
  EXPECT_EQ(d.min, 0);
  EXPECT_EQ(d.p5, 5);
  EXPECT_EQ(d.p25, 25);
  EXPECT_EQ(d.median, 50);
  EXPECT_EQ(d.p75, 75);
  EXPECT_EQ(d.p95, 95);
  EXPECT_EQ(d.p99, 99);
  EXPECT_EQ(d.max, 100);
  EXPECT_EQ(d.mean, 50);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(3350));  // sum of squares 338,350
  const Distribution two = summarize({3, 1});
  EXPECT_EQ(two.median, 2);
  EXPECT_EQ(two.p25, 1.5);
}

TEST(Distribution, OfFewValues) {
  EXPECT_EQ(summarize({}).count, 0u);
  EXPECT_EQ(summarize({}).max, 0);
  const Distribution one = summarize({-7});
  for (const double v : {one.min, one.p5, one.median, one.p99, one.max, one.mean}) EXPECT_EQ(v, -7);
  EXPECT_EQ(one.rms, 7);
}

TEST(Histogram, CountsEveryNumberOnce) {
  const std::vector<double> values = {-1, 0, 0.1, 0.25, 0.5, 0.999, 1, 7, NAN};
  const Histogram h = make_histogram(values, 0, 1, 4);
  EXPECT_EQ(h.counts, (std::vector<std::size_t>{3, 1, 1, 3}));
  EXPECT_EQ(make_histogram(values, 1, 1, 2).counts, (std::vector<std::size_t>{8, 0}));
  EXPECT_TRUE(make_histogram(values, 0, 1, 0).counts.empty());
}

TEST(FaceMeasures, AreThoseOfTheTriangles) {
  testing::Draw draw(2);
  const TriMesh mesh = testing::random_soup(draw, 100, 1);
  const FaceMeasures all = measure_faces(mesh);
  EXPECT_EQ(all.equiangle_skewness, equiangle_skewness(mesh));
  std::size_t lists = 0;
  for_each_face_measure(all, [&](const char* name, const std::vector<double>& values, double low, double high) {
    ++lists;
    EXPECT_EQ(values.size(), mesh.faces.size()) << name;
    if (low == high) return;
    // Means of a dozen roundings of numbers up to 180.
    for (const double v : values) EXPECT_TRUE(v >= low - 1e-12 && v <= high + 1e-12) << name << " " << v;
  });
  EXPECT_EQ(lists, 7u);
  const auto& [a, b, c] = mesh.faces[42];
  const TriangleMeasures one = measure_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  EXPECT_EQ(all.area_mm2[42], one.area_mm2);
  EXPECT_EQ(all.max_angle_deg[42], one.max_angle_deg);
}

TEST(Defects, OfASoundMeshAreNone) {
  const DefectReport report = find_defects(testing::icosphere(2));
  EXPECT_TRUE(report.topology.closed && report.topology.manifold && report.topology.outward);
  EXPECT_TRUE(report.degenerate_faces.empty() && report.duplicate_faces.empty());
  EXPECT_TRUE(report.self_intersections.empty());
  EXPECT_EQ(report.vertices_of_valence, (std::map<Index, std::size_t>{{5, 12}, {6, 150}}));
}

TEST(Defects, KnowTheirPlace) {
  const TriMesh two = testing::cube() + testing::moved(testing::tetrahedron(), {0.9, 0.4, 0.4});
  const DefectReport report = find_defects(two);
  ASSERT_FALSE(report.self_intersections.empty());
  for (const IntersectingFaces& pair : report.self_intersections) {
    EXPECT_LT(pair.first, pair.second);
    EXPECT_LT((pair.position - Vec3(1, 0.5, 0.5)).norm(), 1);  // within a cube's edge of where they meet
  }
}

TEST(Defects, OfBadInputAreRefused) {
  TriMesh bad_number = testing::cube(), bad_index = testing::cube();
  bad_number.vertices[5].z() = INFINITY;
  bad_index.faces[3][0] = 100;
  for (const TriMesh& bad : {bad_number, bad_index}) {
    EXPECT_THROW(measure_faces(bad), InvalidInput);
    EXPECT_THROW(find_defects(bad), InvalidInput);
  }
  EXPECT_TRUE(measure_faces({}).area_mm2.empty());
  EXPECT_FALSE(find_defects({}).topology.closed);
}

}  // namespace
}  // namespace vmesh
