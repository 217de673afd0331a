#include "surface/junction/disc_cutter.h"

#include <algorithm>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "draw.h"
#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

using testing::Draw;

std::vector<Vec3> docked_ring(int count, double radius, double height, double turn = 0) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * (i + turn) / count;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  }
  return points;
}

// A cylinder around z from -5 to 5, closed by poles.
TriMesh closed_cylinder(int around, int rings) {
  TriMesh mesh;
  for (int k = 0; k < rings; ++k) {
    const auto points = docked_ring(around, 1, -5 + 10.0 * k / (rings - 1), 0.5 * (k % 2));
    mesh.vertices.insert(mesh.vertices.end(), points.begin(), points.end());
  }
  const auto at = [&](int k, int i) { return static_cast<Index>(k * around + i % around); };
  for (int k = 0; k + 1 < rings; ++k) {
    for (int i = 0; i < around; ++i) {
      mesh.faces.push_back({at(k, i), at(k, i + 1), at(k + 1, i)});
      mesh.faces.push_back({at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)});
    }
  }
  const auto south = static_cast<Index>(mesh.vertices.size()), north = south + 1;
  mesh.vertices.emplace_back(0, 0, -5.5);
  mesh.vertices.emplace_back(0, 0, 5.5);
  for (int i = 0; i < around; ++i) {
    mesh.faces.push_back({at(0, i + 1), at(0, i), south});
    mesh.faces.push_back({at(rings - 1, i), at(rings - 1, i + 1), north});
  }
  return mesh;
}

std::vector<Index> all_vertices(const TriMesh& mesh) {
  std::vector<Index> all(mesh.vertices.size());
  for (Index v = 0; v < all.size(); ++v) all[v] = v;
  return all;
}

TEST(Stitch, UsesEveryEdgeOfBothLoopsOnceAndNoneTwice) {
  for (const auto& [n, m] : {std::pair(3, 3), {6, 6}, {6, 9}, {15, 6}, {40, 7}, {3, 30}}) {
    SCOPED_TRACE(std::to_string(n) + " to " + std::to_string(m));
    const auto bottom = docked_ring(n, 1, 0), top = docked_ring(m, 1.3, 1, 0.37);
    const auto faces = stitch(bottom, top);
    EXPECT_EQ(faces.size(), bottom.size() + top.size());
    TriMesh mesh{bottom, faces};
    mesh.vertices.insert(mesh.vertices.end(), top.begin(), top.end());
    const Topology topology = measure_topology(mesh);
    EXPECT_TRUE(topology.manifold && topology.oriented);
    EXPECT_EQ(topology.boundary_edges, bottom.size() + top.size());
    EXPECT_EQ(topology.euler_characteristic, 0);  // an annulus
    EXPECT_TRUE(self_intersections(mesh).empty());
    for (const auto& [a, b, c] : faces) {  // outwards
      const Vec3 normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
      const Vec3 middle = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
      EXPECT_GT(normal.dot(Vec3(middle.x(), middle.y(), 0)), 0);
    }
  }
}

TEST(Stitch, MakesEquilateralTrianglesBetweenRingsTurnedHalfAStep) {
  const auto bottom = docked_ring(6, 1, 0), top = docked_ring(6, 1, 0.9, 0.5);
  for (const auto& face : stitch(bottom, top)) {
    const auto at = [&](Index i) { return i < 6 ? bottom[i] : top[i - 6]; };
    for (int i = 0; i < 3; ++i) EXPECT_LT((at(face[i]) - at(face[(i + 1) % 3])).norm(), 1.05);
  }
}

// Sum of the squared edges across the shortest band from the edge (first, start), of all pairs of vertices.
double shortest_band(const std::vector<Vec3>& bottom, const std::vector<Vec3>& top, std::size_t first,
                     std::size_t start) {
  const std::size_t n = bottom.size(), m = top.size();
  std::vector<double> cost((n + 1) * (m + 1), std::numeric_limits<double>::infinity());
  const auto at = [&](std::size_t i, std::size_t j) -> double& { return cost[i * (m + 1) + j]; };
  at(0, 0) = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) {
      if (i + j == 0 || std::abs(double(i) / double(n) - double(j) / double(m)) >= 0.5) continue;
      const double edge = (bottom[(first + i) % n] - top[(start + j) % m]).squaredNorm();
      at(i, j) = edge + std::min(i > 0 ? at(i - 1, j) : 1e300, j > 0 ? at(i, j - 1) : 1e300);
    }
  }
  return at(n, m);
}

// Of the many pairs of two long loops few are looked at, but never so few that a shorter band is missed.
TEST(Stitch, IsTheShortestBand) {
  Draw draw(31);
  for (const auto& [n, m] : {std::pair(96, 96), {96, 48}, {60, 17}, {7, 90}, {5, 4}}) {
    for (const double noise : {0.0, 0.02, 0.3}) {
      SCOPED_TRACE(std::to_string(n) + " to " + std::to_string(m) + ", noise " + std::to_string(noise));
      auto bottom = docked_ring(n, 1, 0), top = docked_ring(m, 1.1, 0.3, draw.uniform(0, 1));
      for (auto* loop : {&bottom, &top}) {
        for (Vec3& p : *loop) p += noise * draw.in_cube(1);
      }
      // Squared edges across: every one belongs to two faces.
      double across = 0;
      const auto point = [&](Index i) { return i < bottom.size() ? bottom[i] : top[i - bottom.size()]; };
      for (const Triangle& face : stitch(bottom, top)) {
        for (int k = 0; k < 3; ++k) {
          const Index a = face[k], b = face[(k + 1) % 3];
          if ((a < bottom.size()) != (b < bottom.size())) across += 0.5 * (point(a) - point(b)).squaredNorm();
        }
      }
      // It starts at the vertex that is nearest to the other loop, and there at one of the six nearest.
      const auto nearest = [&](const Vec3& p) {
        std::vector<std::pair<double, std::size_t>> order;
        for (std::size_t j = 0; j < top.size(); ++j) order.emplace_back((top[j] - p).squaredNorm(), j);
        std::sort(order.begin(), order.end());
        return order;
      };
      std::size_t first = 0;
      for (std::size_t i = 1; i < bottom.size(); ++i) {
        if (nearest(bottom[i])[0].first < (1 - 1e-9) * nearest(bottom[first])[0].first) first = i;
      }
      double shortest = std::numeric_limits<double>::infinity();
      const auto order = nearest(bottom[first]);
      for (std::size_t k = 0; k < std::min<std::size_t>(6, order.size()); ++k)
        shortest = std::min(shortest, shortest_band(bottom, top, first, order[k].second));
      EXPECT_NEAR(across, shortest, 1e-8 * shortest);
    }
  }
}

TEST(DiscCutter, CutsATipOffAtThePlane) {
  const TriMesh mesh = closed_cylinder(8, 11);
  DiscCutter cutter(mesh.vertices, mesh.faces);
  const auto rim = cutter.cut({0, 0, 2.6}, Vec3::UnitZ(), all_vertices(mesh), 0);
  ASSERT_GE(rim.size(), 8u);
  const TriMesh rest = cutter.rest();
  double turn = 0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 &p = rest.vertices[rim[i]], &q = rest.vertices[rim[(i + 1) % rim.size()]];
    EXPECT_NEAR(p.z(), 2.6, 1e-12);
    turn += std::atan2(p.x() * q.y() - p.y() * q.x(), p.x() * q.x() + p.y() * q.y());
  }
  EXPECT_NEAR(turn, 2 * M_PI, 1e-9);  // once, counter-clockwise about the normal
  const Topology topology = measure_topology(rest);
  EXPECT_TRUE(topology.manifold && topology.oriented);
  EXPECT_EQ(topology.boundary_edges, rim.size());
  EXPECT_EQ(topology.euler_characteristic, 1);  // a disc is left
  for (const Triangle& face : rest.faces) {
    for (const Index v : face) EXPECT_LE(rest.vertices[v].z(), 2.6 + 1e-12);
  }
}

TEST(DiscCutter, CollapsesShortEdgesOfTheRim) {
  const TriMesh mesh = closed_cylinder(24, 31);
  DiscCutter cutter(mesh.vertices, mesh.faces);
  const auto rim = cutter.cut({0, 0, 2.6}, Vec3::UnitZ(), all_vertices(mesh), 0.4);
  // Cut as it is, the rim has an edge for each of the 48 edges that cross the plane. Where two vertices of the rim have
  // more than one neighbour in common, their edge stays.
  EXPECT_LE(rim.size(), 24u);
  EXPECT_GE(rim.size(), 12u);  // 2 pi / 0.5: none longer than needed on average
  const Topology topology = measure_topology(cutter.rest());
  EXPECT_TRUE(topology.manifold && topology.oriented);
  EXPECT_EQ(topology.boundary_edges, rim.size());
  EXPECT_EQ(topology.euler_characteristic, 1);
}

TEST(DiscCutter, CutsBothEndsWithoutTheRimsTouching) {
  const TriMesh mesh = closed_cylinder(6, 5);
  DiscCutter cutter(mesh.vertices, mesh.faces);
  std::vector<Index> upper, lower;
  for (const Index v : all_vertices(mesh)) (mesh.vertices[v].z() > 0 ? upper : lower).push_back(v);
  const auto first = cutter.cut({0, 0, 0.1}, Vec3::UnitZ(), upper, 0);
  const auto second = cutter.cut({0, 0, -0.1}, -Vec3::UnitZ(), lower, 0);
  for (const Index v : second) EXPECT_EQ(std::count(first.begin(), first.end(), v), 0);
  const Topology topology = measure_topology(cutter.rest());
  EXPECT_TRUE(topology.manifold && topology.oriented);
  EXPECT_EQ(topology.boundary_edges, first.size() + second.size());
  EXPECT_EQ(topology.euler_characteristic, 0);
}

TEST(DiscCutter, OpensAWindowWhereTheTipHasNoVertex) {
  const TriMesh mesh = closed_cylinder(6, 5);
  DiscCutter cutter(mesh.vertices, mesh.faces);
  const auto rim = cutter.cut({1, 0, 0.3}, Vec3::UnitX(), {}, 0);
  EXPECT_EQ(rim.size(), 3u);
  const Topology topology = measure_topology(cutter.rest());
  EXPECT_TRUE(topology.manifold && topology.oriented);
  EXPECT_EQ(topology.boundary_edges, 3u);
}

}  // namespace
}  // namespace vmesh
