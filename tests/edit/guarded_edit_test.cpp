#include "vmesh/edit/guarded_edit.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "draw.h"
#include "sphere.h"

namespace vmesh {
namespace {

using testing::Draw;
using testing::middle_of;
using testing::plain_mesh;
using testing::PlainMesh;

// Two spheres of radius 1 whose centres are 2.2 apart.
PlainMesh two_spheres() {
  TriMesh mesh = testing::icosphere(1);
  const auto count = static_cast<Index>(mesh.vertices.size());
  for (Index v = 0; v < count; ++v) mesh.vertices.push_back(mesh.vertices[v] + Vec3(2.2, 0, 0));
  const std::vector<Triangle> faces = mesh.faces;
  for (const auto& [a, b, c] : faces) mesh.faces.push_back({a + count, b + count, c + count});
  return plain_mesh(mesh);
}

TEST(GuardedEdit, TakesExactlyTheStepsAfterWhichNothingCrosses) {
  Draw draw(6);
  PlainMesh mesh = two_spheres();
  GuardedEdit edit(mesh);
  int taken = 0, refused = 0;
  for (int i = 0; i < 600; ++i) {
    const std::vector<MeshEdge> edges = mesh.edges();
    const MeshEdge e = edges[draw.below(static_cast<Index>(edges.size()))];
    const Vec3 p = middle_of(mesh, e) + 0.3 * draw.in_cube(1);
    PlainMesh::Step step;
    const Index kind = draw.below(4);
    if (kind == 0 && mesh.may_flip(e)) step = mesh.flipping(e);
    if (kind == 1) step = mesh.splitting(e, {p});
    if (kind == 2 && mesh.may_collapse(e)) step = mesh.collapsing(e.a, e.b, {p});
    if (kind == 3) step = mesh.moving(e.a, {p});
    if (step.faces.empty()) continue;
    PlainMesh after = mesh;
    after.take(step);
    const bool is_sound = self_intersections(after.tri_mesh()).empty() && degenerate_faces(after.tri_mesh()).empty();
    EXPECT_EQ(edit.take_best({step}, 1) != kNone, is_sound);
    ++(is_sound ? taken : refused);
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
  EXPECT_TRUE(self_intersections(mesh.tri_mesh()).empty());
}

TEST(GuardedEdit, TakesTheStepThatLeavesTheBestTriangles) {
  PlainMesh mesh = two_spheres();
  GuardedEdit edit(mesh);
  const MeshEdge e = mesh.edges().front();
  const Vec3 a = mesh.position(e.a), b = mesh.position(e.b);
  const std::vector<PlainMesh::Step> steps = {mesh.splitting(e, {0.9 * a + 0.1 * b}),
                                              mesh.splitting(e, {0.5 * (a + b)}),
                                              mesh.splitting(e, {0.2 * a + 0.8 * b})};
  EXPECT_EQ(edit.take_best(steps, 0.1), kNone);
  const Index added = edit.take_best(steps, 0.9);
  ASSERT_NE(added, kNone);
  EXPECT_EQ(mesh.position(added), 0.5 * (a + b));
}

TEST(GuardedEdit, MendsWhatStepsLeftSkew) {
  PlainMesh mesh = two_spheres();
  GuardedEdit edit(mesh);
  const MeshEdge e = mesh.edges().front();
  ASSERT_NE(edit.take_best({mesh.splitting(e, {0.97 * mesh.position(e.a) + 0.03 * mesh.position(e.b)})}, 1), kNone);
  const auto worst = [&] {
    const std::vector<double> all = equiangle_skewness(mesh.tri_mesh());
    return *std::max_element(all.begin(), all.end());
  };
  ASSERT_GT(worst(), 0.9);
  edit.mend(0.5);
  EXPECT_LE(worst(), 0.5);
}

TEST(CrossingPairs, AreThoseOfTheWholeMeshAtTheChangedFaces) {
  PlainMesh mesh = two_spheres();
  PlainMesh::Transaction transaction(mesh);
  for (Index v = 0; v < 42; ++v) {
    if (mesh.position(v).x() > 0.5) mesh.edit(v).position.x() += 0.5;
  }
  const auto found = crossing_pairs(mesh.positions(), mesh.faces(), transaction.changed_faces());
  EXPECT_FALSE(found.empty());
  EXPECT_EQ(found, self_intersections(mesh.tri_mesh()));
}

}  // namespace
}  // namespace vmesh
