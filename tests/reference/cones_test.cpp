#include "vmesh/reference/cones.h"

#include <gtest/gtest.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/synth/synthetic_tree.h"

namespace vmesh {
namespace {

Centerline y_tree() {
  return {{{{0, 0, 0}, 3.0}, {{0, 0, 20}, 2.8}, {{-9, 0, 32}, 2.1}, {{8, 3, 33}, 2.3}}, {{0, 1}, {1, 2}, {3, 1}}};
}

TEST(TruncatedCones, HaveTheStatedCounts) {
  const TruncatedCones cones = truncated_cones(y_tree());
  EXPECT_EQ(cones.mesh.vertices.size(), 3u * 37);
  EXPECT_EQ(cones.mesh.faces.size(), 3u * 70);
  EXPECT_EQ(cones.segment.size(), cones.mesh.vertices.size());
  EXPECT_EQ(cones.radius.size(), cones.mesh.vertices.size());
  const TruncatedCones triangular = truncated_cones(y_tree(), 3);
  EXPECT_EQ(triangular.mesh.vertices.size(), 3u * 7);
  EXPECT_EQ(triangular.mesh.faces.size(), 3u * 10);
}

TEST(TruncatedCones, OfATreeOfThePapersSizeAreAboutAsMany) {
  // The paper has 58,070 vertices for a tree of 1,560 nodes.
  EXPECT_EQ(truncated_cones(synthetic_tree()).mesh.vertices.size(), 1559u * 37);
}

TEST(TruncatedCones, AreClosedApartAndFaceOutwards) {
  for (const int sides : {3, 4, 18, 101}) {
    const Topology topology = measure_topology(truncated_cones(y_tree(), sides).mesh);
    EXPECT_TRUE(topology.closed && topology.manifold && topology.oriented && topology.outward) << sides;
    EXPECT_EQ(topology.components, 3u);
    EXPECT_EQ(topology.genus, 0);
  }
}

TEST(TruncatedCones, HaveTheVolumeOfTheirPyramids) {
  // A frustum with regular n-gons of circumradius R and r over height h: h/3 * (A + a + sqrt(A a)).
  const double area = 0.5 * 18 * std::sin(2 * 3.141592653589793 / 18);
  const Centerline one({{{1, 2, 3}, 3.0}, {{1, 10, 3}, 2.0}}, {{0, 1}});
  EXPECT_NEAR(enclosed_volume(truncated_cones(one).mesh), 8.0 / 3 * area * (9 + 4 + 6), 1e-9);
}

TEST(TruncatedCones, LieAroundTheirNodes) {
  const Centerline tree = y_tree();
  const TruncatedCones cones = truncated_cones(tree);
  for (std::size_t v = 0; v < cones.mesh.vertices.size(); ++v) {
    const CenterlineSegment& segment = tree.segment(cones.segment[v]);
    const bool at_a = v % 37 < 18;
    const CenterlineNode& node = tree.node(at_a ? segment.a : segment.b);
    const Vec3 axis = tree.node(segment.b).position - tree.node(segment.a).position;
    const Vec3 spoke = cones.mesh.vertices[v] - node.position;
    EXPECT_NEAR(spoke.norm(), v % 37 == 36 ? 0 : node.radius, 1e-12);
    EXPECT_NEAR(spoke.dot(axis), 0, 1e-12);
    EXPECT_EQ(cones.radius[v], node.radius);
  }
}

TEST(TruncatedCones, RefuseWhatTheyCannotBe) {
  EXPECT_THROW(truncated_cones(y_tree(), 2), InvalidInput);
  EXPECT_THROW(truncated_cones(y_tree(), 1001), InvalidInput);
  EXPECT_THROW(truncated_cones(Centerline({{{0, 0, 0}, 1}}, {})), InvalidInput);
}

}  // namespace
}  // namespace vmesh
