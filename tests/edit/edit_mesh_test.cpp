#include "vmesh/edit/edit_mesh.h"

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

PlainMesh sphere() { return plain_mesh(testing::icosphere(1)); }

void expect_sphere(PlainMesh mesh, std::size_t vertices) {
  EXPECT_EQ(mesh.vertex_count(), vertices);
  mesh.pack();
  const Topology topology = measure_topology(mesh.tri_mesh());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(mesh.vertices().size(), vertices);
  EXPECT_EQ(mesh.faces().size(), 2 * vertices - 4);  // Euler
}

// Everything that can be asked of a mesh.
void expect_equal(const PlainMesh& a, const PlainMesh& b) {
  EXPECT_EQ(a.faces(), b.faces());
  EXPECT_EQ(a.vertices(), b.vertices());
  for (Index v = 0; v < a.vertices().size(); ++v) EXPECT_EQ(a.faces_around(v), b.faces_around(v));
}

// One random allowed step of any kind.
void take_any(PlainMesh& mesh, Draw& draw) {
  const std::vector<MeshEdge> edges = mesh.edges();
  const MeshEdge e = edges[draw.below(static_cast<Index>(edges.size()))];
  switch (draw.below(4)) {
    case 0:
      if (mesh.may_flip(e)) mesh.take(mesh.flipping(e));
      break;
    case 1:
      mesh.take(mesh.splitting(e, {middle_of(mesh, e)}));
      break;
    case 2:
      if (mesh.may_collapse(e)) mesh.take(mesh.collapsing(e.a, e.b, {middle_of(mesh, e)}));
      break;
    default:
      mesh.take(mesh.moving(e.a, {mesh.position(e.a) + 0.01 * draw.in_cube(1)}));
  }
}

TEST(EditMesh, FlipsAnEdge) {
  PlainMesh mesh = sphere();
  const MeshEdge e = mesh.edges().front();
  const auto [c, d] = mesh.opposite(e);
  ASSERT_TRUE(mesh.may_flip(e));
  mesh.take(mesh.flipping(e));
  EXPECT_FALSE(mesh.are_neighbours(e.a, e.b));
  EXPECT_TRUE(mesh.are_neighbours(c, d));
  expect_sphere(mesh, 42);
}

TEST(EditMesh, SplitsAndCollapsesAnEdge) {
  PlainMesh mesh = sphere();
  const auto [a, b] = mesh.edges().front();
  mesh.take(mesh.splitting({a, b}, {middle_of(mesh, {a, b})}));
  const Index m = 42;
  EXPECT_EQ(mesh.faces_around(m).size(), 4u);
  expect_sphere(mesh, 43);
  ASSERT_TRUE(mesh.may_collapse({m, a}));
  mesh.take(mesh.collapsing(m, a, mesh.vertex(a)));
  EXPECT_TRUE(mesh.are_neighbours(a, b));
  expect_sphere(mesh, 42);
}

TEST(EditMesh, DoesNotCollapseATetrahedron) {
  const PlainMesh mesh = plain_mesh(testing::tetrahedron());
  for (const MeshEdge& e : mesh.edges()) {
    EXPECT_FALSE(mesh.may_collapse(e));
    EXPECT_FALSE(mesh.may_flip(e));
  }
}

TEST(EditMesh, KeepsBorders) {
  const PlainMesh mesh = plain_mesh({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  EXPECT_TRUE(mesh.is_inner(MeshEdge{0, 2}));
  EXPECT_FALSE(mesh.is_inner(MeshEdge{0, 1}));
  EXPECT_FALSE(mesh.is_inner(Index{0}));
  EXPECT_FALSE(mesh.may_collapse({0, 2}));
  EXPECT_EQ(mesh.edges().size(), 5u);
}

TEST(EditMesh, StaysASphereWhateverTheSteps) {
  Draw draw(3);
  PlainMesh mesh = sphere();
  for (int i = 0; i < 2000; ++i) take_any(mesh, draw);
  const std::size_t vertices = mesh.vertex_count();
  mesh.pack();
  const Topology topology = measure_topology(mesh.tri_mesh());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented);
  EXPECT_EQ(topology.genus, 0);
  EXPECT_EQ(mesh.vertices().size(), vertices);
}

TEST(Transaction, UndoesWhatIsNotKept) {
  Draw draw(4);
  PlainMesh mesh = sphere();
  for (int trial = 0; trial < 40; ++trial) {
    const PlainMesh before = mesh;
    {
      const PlainMesh::Transaction transaction(mesh);
      for (int i = 0; i < 25; ++i) take_any(mesh, draw);
    }
    expect_equal(mesh, before);
    for (int i = 0; i < 5; ++i) take_any(mesh, draw);
  }
}

TEST(Transaction, InOneThatIsUndoneIsUndoneWhetherKeptOrNot) {
  Draw draw(5);
  PlainMesh mesh = sphere();
  const PlainMesh before = mesh;
  {
    PlainMesh::Transaction outer(mesh);
    for (int i = 0; i < 25; ++i) take_any(mesh, draw);
    const PlainMesh between = mesh;
    {
      const PlainMesh::Transaction inner(mesh);
      for (int i = 0; i < 25; ++i) take_any(mesh, draw);
    }
    expect_equal(mesh, between);
    {
      PlainMesh::Transaction inner(mesh);
      for (int i = 0; i < 25; ++i) take_any(mesh, draw);
      inner.keep();
    }
    outer.undo();
    expect_equal(mesh, before);
    for (int i = 0; i < 25; ++i) take_any(mesh, draw);
  }
  expect_equal(mesh, before);
}

TEST(Transaction, KnowsTheFacesThatChanged) {
  PlainMesh mesh = sphere();
  PlainMesh::Transaction transaction(mesh);
  EXPECT_TRUE(transaction.changed_faces().empty());
  const MeshEdge e = mesh.edges().front();
  const std::vector<Index> both = mesh.flipping(e).gone;
  mesh.take(mesh.flipping(e));
  std::vector<Index> changed = transaction.changed_faces();
  EXPECT_EQ(changed, (std::vector<Index>{std::min(both[0], both[1]), std::max(both[0], both[1])}));
  mesh.edit(40).position *= 1.01;
  std::vector<Index> replaced = mesh.replaced_faces();
  std::sort(replaced.begin(), replaced.end());
  EXPECT_EQ(replaced, changed);  // a moved vertex replaces none
  changed = transaction.changed_faces();
  for (const Index f : mesh.faces_around(40)) EXPECT_TRUE(std::binary_search(changed.begin(), changed.end(), f));
  transaction.keep();
}

}  // namespace
}  // namespace vmesh
