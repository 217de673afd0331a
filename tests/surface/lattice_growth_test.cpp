#include "surface/junction/lattice_growth.h"

#include <set>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "draw.h"
#include "surface/junction/thinning.h"

namespace vmesh {
namespace {

using testing::Draw;

TriMesh mesh_of(const LatticeSurface& surface) { return {surface.vertices, surface.faces}; }

Eigen::Matrix3d any_frame() { return Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(); }

// A lattice around all of a volume, uniform or as fine as `fineness` radii in every vessel.
GradedLattice lattice_around(const VesselField& field, const Vec3& origin, double spacing, double fineness = 0) {
  std::vector<LatticeBall> balls;
  for (Index cone = 0; cone < field.relations().cone_count(); ++cone) {
    for (double t = 0; t <= 1; t += 1.0 / 32) {
      const double radius = field.relations().radius_at(cone, t);
      balls.push_back(
          {field.relations().axis_point(cone, t), 1.25 * radius, fineness > 0 ? fineness * radius : spacing});
    }
  }
  return {origin, any_frame(), spacing, balls};
}

LatticeSurface grow_around(const VesselField& field, const Vec3& seed, double spacing, std::size_t max_handles,
                           double fineness = 0) {
  return grow_in_lattice(field, lattice_around(field, seed, spacing, fineness), 0, max_handles);
}

void expect_topology(const LatticeSurface& surface, std::int64_t genus) {
  const Topology topology = measure_topology(mesh_of(surface));
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, genus);
  EXPECT_EQ(surface.cones.size(), surface.vertices.size());
  EXPECT_EQ(surface.points.size(), surface.vertices.size());
}

// Thinned too.
void expect_surface_of_genus(const LatticeSurface& surface, std::int64_t genus) {
  expect_topology(surface, genus);
  EXPECT_TRUE(self_intersections(mesh_of(surface)).empty());
  expect_topology(thinned(surface), genus);
}

TEST(LatticeGrowth, FillsABallToHalfASpacing) {
  const Centerline centerline({{{1, 2, 3}, 2}}, {});
  const VesselField field(centerline);
  const double spacing = 0.4;
  const auto surface = grow_around(field, {1, 2, 3}, spacing, 0);
  expect_surface_of_genus(surface, 0);
  // A vertex lies on an edge (at most one spacing) between a point inside and one outside, off both by a quarter of it.
  for (const Vec3& v : surface.vertices) EXPECT_LT(std::abs((v - Vec3(1, 2, 3)).norm() - 2), 0.75 * spacing);
  const double volume = 4.0 / 3 * M_PI * 8;
  EXPECT_NEAR(enclosed_volume(mesh_of(surface)), volume, 0.1 * volume);
}

// A point of the lattice at a smooth wall cuts off about five vertices, which become one among them.
TEST(LatticeGrowth, ThinsASmoothWallToOneVertexAPoint) {
  const Centerline centerline({{{1, 2, 3}, 2}}, {});
  const VesselField field(centerline);
  const double spacing = 0.4;
  const LatticeSurface surface = grow_around(field, {1, 2, 3}, spacing, 0);
  const std::set<Index> points(surface.points.begin(), surface.points.end());
  const LatticeSurface thin = thinned(surface);
  EXPECT_LT(4 * points.size(), surface.vertices.size());
  EXPECT_LT(static_cast<double>(thin.vertices.size()), 1.1 * static_cast<double>(points.size()));
  EXPECT_TRUE(self_intersections(mesh_of(thin)).empty());
  for (const Vec3& v : thin.vertices) EXPECT_LT(std::abs((v - Vec3(1, 2, 3)).norm() - 2), 0.75 * spacing);
}

// Where the lattice is coarse, most groups hold the surface open or apart: those stay as they are.
TEST(LatticeGrowth, ThinsWithoutClosingAHandle) {
  Draw draw(5);
  for (int i = 0; i < 40; ++i) {
    std::vector<CenterlineNode> nodes;
    std::vector<CenterlineSegment> segments;
    for (Index n = 0; n < 8; ++n) {
      const double angle = 2 * M_PI * n / 8;
      nodes.push_back({draw.uniform(1.2, 3) * Vec3(std::cos(angle), std::sin(angle), 0), 0.5});
      segments.push_back({n, (n + 1) % 8});
    }
    const Centerline centerline(nodes, segments);
    const VesselField field(centerline);
    const LatticeSurface surface = grow_around(field, nodes[0].position, draw.uniform(0.4, 0.8), 1);
    SCOPED_TRACE(i);
    expect_topology(thinned(surface), static_cast<std::int64_t>(surface.handles));
  }
}

TEST(LatticeGrowth, HoldsTheSeedInAVesselThinnerThanTheLattice) {
  const Centerline centerline({{{0, 0, 0}, 0.1}, {{5, 0, 0}, 0.1}}, {{0, 1}});
  const VesselField field(centerline);
  const auto surface = grow_around(field, {0, 0, 0}, 1, 0);
  expect_surface_of_genus(surface, 0);
  EXPECT_TRUE(points_inside(mesh_of(surface), {{0, 0, 0}})[0]);
}

// A ring's two fronts meet: they stay apart, or are joined where a handle is allowed.
TEST(LatticeGrowth, ClosesARingOnlyWhenAllowed) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (Index i = 0; i < 12; ++i) {
    const double angle = 2 * M_PI * i / 12;
    nodes.push_back({4 * Vec3(std::cos(angle), std::sin(angle), 0), 1});
    segments.push_back({i, (i + 1) % 12});
  }
  const Centerline centerline(nodes, segments);
  const VesselField field(centerline);
  for (const std::size_t allowed : {0u, 1u, 5u}) {
    const auto surface = grow_around(field, nodes[0].position, 0.5, allowed);
    EXPECT_EQ(surface.handles, std::min<std::size_t>(allowed, 1));
    expect_surface_of_genus(surface, static_cast<std::int64_t>(surface.handles));
  }
}

// A vessel a thousand times thinner than the one that it leaves is entered to its end.
TEST(LatticeGrowth, EntersAVesselThinnerByAnyFactor) {
  const double thin = 1e-3;
  const Centerline centerline({{{0, 0, 0}, 1}, {{0.9, 0, 0}, thin}, {{1.02, 0.01, 0}, thin}, {{1.03, 0, 0.01}, thin}},
                              {{0, 1}, {1, 2}, {2, 3}});
  const VesselField field(centerline);
  std::vector<LatticeBall> balls = {{Vec3::Zero(), 1.25, 1}};
  for (Index cone = 0; cone < 3; ++cone) {
    const double length = (field.relations().axis_point(cone, 1) - field.relations().axis_point(cone, 0)).norm();
    for (double t = 0; t <= 1; t += 0.5 * thin / length)
      balls.push_back(
          {field.relations().axis_point(cone, t), 1.25 * thin, std::max(thin, field.relations().radius_at(cone, t))});
  }
  const auto surface = grow_in_lattice(field, {Vec3::Zero(), any_frame(), 1, balls}, 0, 0);
  expect_surface_of_genus(surface, 0);
  const std::vector<bool> inside = points_inside(mesh_of(surface), {{1.02, 0.01, 0}, {1.03, 0, 0.01}});
  EXPECT_TRUE(inside[0] && inside[1]);
  EXPECT_LT(surface.vertices.size(), 20'000u);  // an even lattice that fine would have a billion around the ball
}

/// In parts, which run at the same time.
class Tangles : public ::testing::TestWithParam<std::uint32_t> {};

INSTANTIATE_TEST_SUITE_P(LatticeGrowth, Tangles, ::testing::Range(5u, 9u));

// Whatever the volume, the surface is a sphere.
TEST_P(Tangles, BecomeSpheres) {
  Draw draw(GetParam());
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<CenterlineNode> nodes = {{Vec3::Zero(), draw.uniform(0.3, 1)}};
    std::vector<CenterlineSegment> segments;
    for (Index i = 1; i < 12; ++i) {
      const Vec3 place = draw.in_cube(2);
      nodes.push_back({place, draw.uniform(0.3, 1)});
      segments.push_back({draw.below(i), i});
    }
    const Centerline centerline(nodes, segments);
    const VesselField field(centerline, 0.5);
    expect_surface_of_genus(grow_around(field, Vec3::Zero(), 0.4, 0), 0);
    expect_surface_of_genus(grow_around(field, Vec3::Zero(), 0.8, 0, 0.5), 0);
  }
}

TEST(LatticeGrowth, ScalesBitForBitByPowersOfTwo) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{3, 1, 0}, 0.7}, {{-2, 2, 1}, 0.8}}, {{0, 1}, {0, 2}});
  const Centerline large({{{0, 0, 0}, 64}, {{192, 64, 0}, 0.7 * 64}, {{-128, 128, 64}, 0.8 * 64}}, {{0, 1}, {0, 2}});
  const auto a = grow_around(VesselField(centerline, 0.5), Vec3::Zero(), 0.8, 0, 0.3);
  const auto b = grow_around(VesselField(large, 0.5), Vec3::Zero(), 0.8 * 64, 0, 0.3);
  ASSERT_EQ(a.faces, b.faces);
  for (std::size_t v = 0; v < a.vertices.size(); ++v) EXPECT_EQ(64 * a.vertices[v], b.vertices[v]);
}

}  // namespace
}  // namespace vmesh
