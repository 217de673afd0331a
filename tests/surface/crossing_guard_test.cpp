// Remeshing steps after which faces would cross are refused, others allowed.
#include "vmesh/edit/crossing_guard.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"
#include "vmesh/mesh/triangle_quality.h"

#include "draw.h"
#include "surface/paper/geodesic_sphere.h"
#include "surface/remesh/mend.h"
#include "surface/remesh/untangle.h"

namespace vmesh {
namespace {

using testing::Draw;

// Two spheres of radius 1 whose centres are `apart`, in one mesh.
struct TwoSpheres {
  explicit TwoSpheres(double apart)
      : centerline({{{0, 0, 0}, 1}, {{apart, 0, 0}, 1}}, {}), field(centerline), surface(field) {
    for (const Index cone : {0u, 1u})
      add_geodesic_sphere(surface, centerline.node(cone).position, 1, Eigen::Matrix3d::Identity(), cone);
  }
  double worst_skewness() {
    const std::vector<double> all = equiangle_skewness(indexed_mesh(SweepState(surface), true));
    return *std::max_element(all.begin(), all.end());
  }
  std::size_t crossings() { return self_intersections(indexed_mesh(SweepState(surface), true)).size(); }

  Centerline centerline;
  VesselField field;
  BoundSurface surface;
};

TEST(CrossingGuard, AllowsExactlyTheMovesAfterWhichNothingCrosses) {
  TwoSpheres spheres(2.2);
  ASSERT_EQ(spheres.crossings(), 0u);
  spheres.surface.guard_crossings();
  Draw draw(5);
  int allowed = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const Vertex v(draw.below(static_cast<Index>(spheres.surface.mesh.num_vertices())));
    const Vec3 before = spheres.surface.position(v), after = before + 0.5 * draw.in_cube(1);
    const bool may = spheres.surface.may_place(v, after);
    spheres.surface.place(v, after, spheres.field.sample(after, spheres.surface[v].cone));
    EXPECT_EQ(may, spheres.crossings() == 0);
    if (!may) spheres.surface.place(v, before, spheres.field.sample(before, spheres.surface[v].cone));
    ++(may ? allowed : refused);
  }
  EXPECT_GT(allowed, 50);
  EXPECT_GT(refused, 50);
  EXPECT_EQ(spheres.crossings(), 0u);
}

// A face between an edge and a vertex on its midpoint, as rounding leaves it, has no halves.
TEST(CrossingGuard, RefusesTheSplitsOfASliverAndAllowsOthers) {
  TwoSpheres spheres(2.2);
  BoundSurface& surface = spheres.surface;
  const SurfaceMesh& mesh = surface.mesh;
  const Halfedge h = mesh.halfedge(Face(17));
  const Vertex a = mesh.source(h), b = mesh.target(h), c = mesh.target(mesh.next(h));
  EXPECT_TRUE(surface.may_split(mesh.edge(h)) && surface.may_split_edge_centric(Face(17)));  // not guarded yet
  const Vec3 middle = 0.5 * (surface.position(a) + surface.position(b));
  surface.place(c, middle, spheres.field.sample(middle, surface[c].cone));
  surface.guard_crossings();
  EXPECT_FALSE(surface.may_split(mesh.edge(h)));
  EXPECT_FALSE(surface.may_split_edge_centric(Face(17)));
  for (const Edge e : mesh.edges()) {
    const bool at_c = mesh.vertex(e, 0) == c || mesh.vertex(e, 1) == c;
    if (at_c || e == mesh.edge(h) || surface[mesh.vertex(e, 0)].cone == 0) continue;
    EXPECT_TRUE(surface.may_split(e));
  }
  for (const Face f : mesh.faces()) {
    if (surface[surface.corners(f)[0]].cone == 0) continue;
    EXPECT_TRUE(surface.may_split_edge_centric(f));
  }
}

TEST(Mend, TakesNeedlesOutWithoutACrossing) {
  TwoSpheres spheres(2.3);
  Draw draw(6);
  spheres.surface.guard_crossings();
  // Vertices next to others: needles.
  for (int i = 0; i < 8; ++i) {
    const Vertex v(draw.below(static_cast<Index>(spheres.surface.mesh.num_vertices())));
    const Vertex w = spheres.surface.mesh.source(spheres.surface.mesh.halfedge(v));
    const Vec3 near = 0.97 * spheres.surface.position(w) + 0.03 * spheres.surface.position(v);
    if (spheres.surface.may_place(v, near))
      spheres.surface.place(v, near, spheres.field.sample(near, spheres.surface[v].cone));
  }
  ASSERT_GT(spheres.worst_skewness(), 0.8);
  EXPECT_TRUE(mend_worst_faces(spheres.surface, 0.5));
  EXPECT_LE(spheres.worst_skewness(), 0.5);
  EXPECT_EQ(spheres.crossings(), 0u);
  EXPECT_FALSE(mend_worst_faces(spheres.surface, 0.5));
}

// Vertices a third of the way to a neighbour: skewed, yet not bad enough to mend.
TEST(ImproveWorstFaces, LowersTheWorstSkewnessOnTheBoundaryWithoutACrossing) {
  constexpr double kLift = 0.02;
  TwoSpheres spheres(2.3);
  BoundSurface& surface = spheres.surface;
  for (const Vertex v : surface.mesh.vertices()) {
    surface[v].lift = kLift;
    surface.place_on_boundary(v, surface.position(v), surface[v].cone);
  }
  const double even = spheres.worst_skewness();
  Draw draw(7);
  for (int i = 0; i < 8; ++i) {
    const Vertex v(draw.below(static_cast<Index>(surface.mesh.num_vertices())));
    const Vertex w = surface.mesh.source(surface.mesh.halfedge(v));
    surface.place_on_boundary(v, 0.67 * surface.position(v) + 0.33 * surface.position(w), surface[v].cone);
  }
  const auto vertices = surface.mesh.number_of_vertices();
  ASSERT_LT(even, 0.24);
  ASSERT_GT(spheres.worst_skewness(), 0.35);
  improve_worst_faces(surface, 0.24);
  EXPECT_LE(spheres.worst_skewness(), 0.24);
  EXPECT_LE(surface.mesh.number_of_vertices(), vertices);
  EXPECT_EQ(spheres.crossings(), 0u);
  // The vertices are at their lift above the boundary, to twice the tolerance of improving, 1e-3 radii.
  for (const Vertex v : surface.mesh.vertices()) EXPECT_NEAR(surface[v].distance, kLift, 2e-3) << v.idx();
}

}  // namespace
}  // namespace vmesh
