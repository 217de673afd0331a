#include "vmesh/mesh/components.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

#include "shapes.h"

namespace vmesh::testing {
namespace {

TEST(Components, ComeApartInTheOrderOfTheirFaces) {
  TriMesh mesh = cube() + moved(tetrahedron(), Vec3(5, 0, 0)) + moved(icosahedron(), Vec3(0, 9, 0));
  mesh.vertices.emplace_back(1, 2, 3);  // without a face
  const std::vector<TriMesh> parts = split_components(mesh);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].vertices, cube().vertices);
  EXPECT_EQ(parts[0].faces, cube().faces);
  EXPECT_EQ(parts[1].faces, tetrahedron().faces);
  EXPECT_EQ(parts[2].vertices.size(), 12u);
  EXPECT_NEAR(enclosed_volume(parts[1]), 1.0 / 6, 1e-12);
}

TEST(Components, JoinedAgainAreTheSame) {
  const TriMesh mesh = cube() + moved(tetrahedron(), Vec3(5, 0, 0));
  const TriMesh again = joined(split_components(mesh));
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.faces, mesh.faces);
}

TEST(Components, OfNothingAreNone) { EXPECT_TRUE(split_components(TriMesh()).empty()); }

TEST(Components, OfFacesWithoutVerticesAreRefused) {
  TriMesh mesh = cube();
  mesh.faces[2][1] = 8;
  EXPECT_THROW(split_components(mesh), InvalidInput);
}

}  // namespace
}  // namespace vmesh::testing
