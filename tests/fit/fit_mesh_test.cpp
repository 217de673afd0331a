#include "fit/fit_mesh.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "../mesh/shapes.h"
#include "fit/fit_patch.h"

namespace vmesh {
namespace {

FitMesh sphere() {
  const TriMesh mesh = testing::icosphere(1);
  std::vector<FitMesh::Vertex> vertices;
  for (const Vec3& p : mesh.vertices) vertices.push_back({p, 0, kNone, 1, 1});
  return {mesh, vertices};
}

void expect_sphere(FitMesh mesh, std::size_t vertices) {
  EXPECT_EQ(mesh.vertex_count(), vertices);
  mesh.pack();
  const Topology topology = measure_topology(mesh.tri_mesh());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(mesh.vertices.size(), vertices);
  EXPECT_EQ(mesh.faces.size(), 2 * vertices - 4);  // Euler
}

TEST(FitMesh, FlipsAnEdge) {
  FitMesh mesh = sphere();
  const auto [a, b] = mesh.edges().front();
  const Index c = FitMesh::apex(mesh.faces[mesh.face_of(a, b)], a, b);
  const Index d = FitMesh::apex(mesh.faces[mesh.face_of(b, a)], a, b);
  mesh.flip(a, b);
  EXPECT_FALSE(mesh.are_neighbours(a, b));
  EXPECT_TRUE(mesh.are_neighbours(c, d));
  expect_sphere(mesh, 42);
}

TEST(FitMesh, SplitsAndCollapsesAnEdge) {
  FitMesh mesh = sphere();
  const auto [a, b] = mesh.edges().front();
  const Index m = mesh.split(a, b, {0.5 * (mesh.position(a) + mesh.position(b)), 0, kNone, 1, 1});
  EXPECT_EQ(mesh.faces_around(m).size(), 4u);
  expect_sphere(mesh, 43);
  ASSERT_TRUE(mesh.may_collapse(a, m));
  mesh.collapse(a, m);
  EXPECT_TRUE(mesh.are_neighbours(a, b));
  expect_sphere(mesh, 42);
}

TEST(FitMesh, DoesNotCollapseToAnEdgeOfFourFaces) {
  const TriMesh tetrahedron = testing::tetrahedron();
  std::vector<FitMesh::Vertex> vertices;
  for (const Vec3& p : tetrahedron.vertices) vertices.push_back({p, 0, kNone, 1, 1});
  const FitMesh mesh(tetrahedron, vertices);
  for (const auto& [a, b] : mesh.edges()) EXPECT_FALSE(mesh.may_collapse(a, b));
}

TEST(FitMesh, ChangesInAPatchThatIsPutBack) {
  FitMesh mesh = sphere();
  FitPatch patch = patch_around(mesh, 20, 0.7);
  EXPECT_LT(patch.faces.size(), mesh.faces.size());
  const auto is_free = [&](Index f) { return patch.moves(f); };
  Index changed = 0;
  while (!is_free(changed)) ++changed;
  const auto [a, b, c] = patch.surface.faces[changed];
  FitMesh::Vertex middle = patch.surface.vertices[a];
  middle.position = 0.5 * (patch.surface.position(a) + patch.surface.position(b));
  const Index m = patch.surface.split(a, b, middle);
  EXPECT_FALSE(is_frozen(patch.frozen, m));
  const std::vector<Index> faces = put_back(mesh, patch);
  EXPECT_EQ(faces.size(), patch.surface.faces.size());
  EXPECT_EQ(mesh.position(42), middle.position);
  expect_sphere(mesh, 43);
}

}  // namespace
}  // namespace vmesh
