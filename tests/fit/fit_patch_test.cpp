#include "fit/fit_patch.h"

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "../mesh/shapes.h"

namespace vmesh::fitting {
namespace {

TEST(FitPatch, IsChangedAndPutBack) {
  const TriMesh sphere = testing::icosphere(1);
  std::vector<FitVertex> vertices;
  for (const Vec3& p : sphere.vertices) vertices.push_back({p, 0, kNone, 1, 1});
  FitMesh mesh(sphere.faces, vertices);
  FitPatch patch = patch_around(mesh, 20, 0.7);
  EXPECT_LT(patch.faces.size(), mesh.faces().size());
  Index changed = 0;
  while (!patch.moves(changed)) ++changed;
  const auto [a, b, c] = patch.surface.faces()[changed];
  const Vec3 middle = 0.5 * (patch.surface.position(a) + patch.surface.position(b));
  const Index m = static_cast<Index>(patch.surface.vertices().size());
  patch.surface.take(
      patch.surface.splitting({a, b}, FitVertex::between(patch.surface.vertex(a), patch.surface.vertex(b), middle)));
  EXPECT_FALSE(is_frozen(patch.frozen, m));
  const std::vector<Index> faces = put_back(mesh, patch);
  EXPECT_EQ(faces.size(), patch.surface.faces().size());
  EXPECT_EQ(mesh.position(42), middle);
  const Topology topology = measure_topology(mesh.tri_mesh());
  EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward);
  EXPECT_EQ(mesh.tri_mesh().faces.size(), 82u);
}

}  // namespace
}  // namespace vmesh::fitting
