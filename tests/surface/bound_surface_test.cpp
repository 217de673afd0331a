#include "surface/remesh/bound_surface.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "centerlines.h"
#include "surface/paper/geodesic_sphere.h"

namespace vmesh {
namespace {

class BoundSurfaceTest : public ::testing::Test {
 protected:
  TriMesh exported() const {
    GenerateResult result;
    surface_.export_to(result);
    return result.mesh;
  }

  Centerline centerline_ = testing::single_node();
  VesselField field_{centerline_};
  BoundSurface surface_{field_};
};

TEST_F(BoundSurfaceTest, AGeodesicSphereHas42VerticesAnd80Faces) {
  const auto vertices = add_geodesic_sphere(surface_, {1, 2, 3}, 1.5, Eigen::Matrix3d::Identity(), 0);
  EXPECT_EQ(vertices.size(), 42u);
  EXPECT_EQ(surface_.mesh.number_of_faces(), 80u);
  const Topology topology = measure_topology(exported());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
  for (const Vertex v : vertices) {
    EXPECT_NEAR((surface_.position(v) - Vec3(1, 2, 3)).norm(), 1.5, 1e-14);
    EXPECT_NEAR(surface_[v].distance, -0.5, 1e-14);
  }
}

TEST_F(BoundSurfaceTest, AnEdgeCentricSplitMakesTenFacesOfFourAndThreeVertices) {
  add_geodesic_sphere(surface_, {1, 2, 3}, 2, Eigen::Matrix3d::Identity(), 0);
  const auto middles = surface_.split_edge_centric(Face(17));
  EXPECT_EQ(surface_.mesh.number_of_vertices(), 45u);
  EXPECT_EQ(surface_.mesh.number_of_faces(), 80u - 4 + 10);
  for (const Vertex v : middles) EXPECT_EQ(surface_.mesh.degree(v), 5u);  // two corners, two middles, one apex
  EXPECT_NE(surface_.mesh.halfedge(middles[0], middles[1]), SurfaceMesh::null_halfedge());
  EXPECT_NE(surface_.mesh.halfedge(middles[1], middles[2]), SurfaceMesh::null_halfedge());
  EXPECT_NE(surface_.mesh.halfedge(middles[2], middles[0]), SurfaceMesh::null_halfedge());
  EXPECT_TRUE(surface_.mesh.is_valid(false));
  const Topology topology = measure_topology(exported());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.outward);
  EXPECT_EQ(topology.euler_characteristic, 2);
}

TEST_F(BoundSurfaceTest, SplittingAnEdgeHalvesItsTwoFaces) {
  add_geodesic_sphere(surface_, {1, 2, 3}, 2, Eigen::Matrix3d::Identity(), 0);
  const Edge e(5);
  const Vec3 middle =
      0.5 * (surface_.position(surface_.mesh.vertex(e, 0)) + surface_.position(surface_.mesh.vertex(e, 1)));
  const Vertex v = surface_.split_edge(e);
  EXPECT_EQ(surface_.position(v), middle);
  EXPECT_EQ(surface_.mesh.degree(v), 4u);
  EXPECT_EQ(surface_.mesh.number_of_faces(), 82u);
  EXPECT_TRUE(surface_.mesh.is_valid(false));
  EXPECT_TRUE(measure_topology(exported()).outward);
}

TEST_F(BoundSurfaceTest, ProjectionReachesTheBoundaryFromInsideAndOutside) {
  for (const double start : {0.3, 1.0, 1.9, 2.5, 30.0}) {
    const BoundaryPoint point = project_to_boundary(field_, Vec3(1, 2, 3) + start * Vec3(1, 1, 0).normalized(), 0);
    EXPECT_NEAR((point.position - Vec3(1, 2, 3)).norm(), 2, 2e-6);  // its tolerance: 1e-6 radii
  }
}

TEST_F(BoundSurfaceTest, ProjectionStopsOnAnAxisWhereThereIsNoDirection) {
  const BoundaryPoint point = project_to_boundary(field_, {1, 2, 3}, 0);
  EXPECT_EQ(point.position, Vec3(1, 2, 3));
  EXPECT_EQ(point.sample.distance, -2);
}

}  // namespace
}  // namespace vmesh
