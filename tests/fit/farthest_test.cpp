#include "fit/farthest.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

namespace vmesh::fitting {
namespace {

/// The wall between the legs of a bifurcation: a ridge along x that sags in its middle.
Vec3 saddle(double x, double y) { return {x, y, 0.12 * x * x - 2 * std::sqrt(y * y + 0.02)}; }

TriMesh sheet(int count, double x_end, double y_end) {
  TriMesh mesh;
  const auto at = [&](int i, double end) { return end * (2.0 * i / count - 1); };
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= count; ++j) mesh.vertices.push_back(saddle(at(i, x_end), at(j, y_end)));
  }
  const auto number = [&](int i, int j) { return static_cast<Index>(i * (count + 1) + j); };
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      mesh.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      mesh.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  return mesh;
}

/// Two triangles on the saddle, with an edge of 5 mm along the ridge, .75 mm above its middle.
FitMesh with_an_edge_along_the_ridge() {
  const std::vector<Vec3> points = {saddle(-2.5, 0), saddle(2.5, 0), saddle(0, 4), saddle(0, -4)};
  std::vector<FitVertex> vertices;
  for (const Vec3& p : points) vertices.push_back({p, 0, 0, 5, 5, kNone});
  return {{{0, 1, 2}, {1, 0, 3}}, vertices};
}

class Ridge : public ::testing::Test {
 protected:
  Centerline centerline_{{{{-10, 0, -8}, 8}, {{10, 0, -8}, 8}}, {{0, 1}}};
  VesselField field_{centerline_};
  FitReference reference_{sheet(40, 5, 4), field_};
  std::vector<ReferenceSample> samples_ = reference_.samples(field_, 2000);
  FitSetting setting_{reference_, field_, {Vec3::UnitZ()}, {}};
  FitMesh surface_ = with_an_edge_along_the_ridge();
};

TEST_F(Ridge, IsSeenByTheMiddleOfTheEdgeAlongIt) {
  Matches matches = find_matches(surface_, reference_, samples_, field_, {3});
  EXPECT_LT(std::abs(farthest_match(surface_, matches, {}).distance), 0.6);
  matches = find_matches(surface_, reference_, samples_, field_, {3, true});
  const Match farthest = farthest_match(surface_, matches, {});
  EXPECT_NEAR(std::abs(farthest.distance), 0.75, 0.02);
  EXPECT_LT(place_of(surface_, farthest).position.head<2>().norm(), 1e-9);
}

TEST_F(Ridge, IsSeenByItsTips) {
  for (const Index v : {0u, 1u}) surface_.edit(v).position.z() += 1;
  surface_.edit(0).position.z() += 2;
  const Matches matches = find_matches(surface_, reference_, {}, field_, {3, true});
  const auto is_tip = [&](const Match& match) {
    return match.face != kNone && (place_of(surface_, match).position - surface_.position(0)).norm() < 1e-9;
  };
  const auto tip = std::find_if(matches.from_edges.begin(), matches.from_edges.end(), is_tip);
  ASSERT_NE(tip, matches.from_edges.end());
  EXPECT_GT(std::abs(tip->distance), 2);
}

TEST_F(Ridge, GetsAVertex) {
  setting_.guard.max_skewness = 0.9;  // halves of them are slim
  bring_farthest_nearer(surface_, samples_, setting_, 5);
  ASSERT_EQ(surface_.vertices().size(), 5u);
  EXPECT_LT((surface_.vertices()[4].position - saddle(0, 0)).norm(), 0.4);
  EXPECT_TRUE(self_intersections(surface_.tri_mesh()).empty());
}

}  // namespace
}  // namespace vmesh::fitting
