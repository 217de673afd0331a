#include "vmesh/surface/branch_labels.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"
#include "vmesh/surface/surface_attributes.h"

#include "centerlines.h"

namespace vmesh {
namespace {

/// A mesh whose vertices are bound to the segments given, with these faces; positions play no role.
BranchLabels labels(const std::vector<Index>& segments, const std::vector<Triangle>& faces,
                    const Centerline& centerline) {
  std::vector<CenterlineBinding> binding;
  for (const Index s : segments) binding.push_back({s, 0.5});
  return label_branches({std::vector<Vec3>(segments.size(), Vec3::Zero()), faces}, binding, centerline);
}

TEST(BranchLabels, SegmentsOfOneBranchHaveOneLabel) {
  // The fork's branches: its trunk (segment 0), one arm (1, 2), the other (3, 4).
  const auto result = labels({0, 1, 2, 3, 4}, {}, testing::fork());
  EXPECT_EQ(result.vertex, (std::vector<Index>{0, 1, 1, 2, 2}));
}

TEST(BranchLabels, AFaceGoesWithMostOfItsCornersElseWithTheLowestLabel) {
  const auto result =
      labels({0, 1, 2, 3, 4}, {{0, 1, 2}, {1, 0, 2}, {2, 1, 0}, {3, 0, 4}, {4, 2, 0}, {2, 4, 1}}, testing::fork());
  EXPECT_EQ(result.face, (std::vector<Index>{1, 1, 1, 2, 0, 1}));
}

TEST(BranchLabels, IsolatedNodesFollowTheBranches) {
  const Centerline centerline({{{0, 0, 0}, 1}, {{9, 0, 0}, 1}, {{0, 9, 0}, 1}, {{0, 0, 9}, 1}}, {{1, 2}});
  ASSERT_EQ(find_branches(centerline).size(), 1u);
  EXPECT_EQ(labels({0, 1, 2}, {}, centerline).vertex, (std::vector<Index>{0, 1, 2}));
}

TEST(BranchLabels, RefusesBindingsThatDoNotFit) {
  EXPECT_THROW(labels({5}, {}, testing::fork()), InvalidInput);
  EXPECT_THROW(labels({kNone}, {}, testing::fork()), InvalidInput);
  EXPECT_THROW(label_branches({{{0, 0, 0}}, {}}, {}, testing::fork()), InvalidInput);
}

Vec3 center_of(const TriMesh& mesh, const Triangle& face) {
  return (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
}

TEST(BranchLabels, OfAGeneratedForkLieAroundTheirBranches) {
  const Centerline centerline = testing::fork();
  const std::vector<Vec3> ends = {{-8, 0, 0}, centerline.node(3).position, centerline.node(5).position};
  const auto nearest_end = [&ends](const Vec3& p) {
    return std::min_element(ends.begin(), ends.end(),
                            [&p](const Vec3& a, const Vec3& b) { return (a - p).norm() < (b - p).norm(); }) -
           ends.begin();
  };
  const GenerateResult result = generate_surface(centerline);
  const BranchLabels labels = label_branches(result.mesh, result.binding, centerline);
  ASSERT_EQ(labels.face.size(), result.mesh.faces.size());
  std::vector<int> faces_of(ends.size(), 0);
  for (std::size_t f = 0; f < result.mesh.faces.size(); ++f) {
    const Vec3 center = center_of(result.mesh, result.mesh.faces[f]);
    if (center.norm() < 4) continue;  // the junction
    EXPECT_EQ(labels.face[f], nearest_end(center)) << "face " << f;
    ++faces_of[labels.face[f]];
  }
  for (const int count : faces_of) EXPECT_GT(count, 10);
}

TEST(AttributeBlocks, AreTheAttributesOfTheWhole) {
  const Centerline centerline = testing::fork();
  GenerateOptions options;
  options.open_ends.all = true;
  const GenerateResult r = generate_surface(centerline, options);
  ASSERT_FALSE(r.openings.empty());
  const MeshAttributes whole = surface_attributes(r.mesh, r.binding, r.radius, r.openings, centerline);
  const AttributeBlocks blocks(r.mesh, r.binding, r.radius, r.openings, centerline);
  const auto expect_same = [](const std::vector<MeshAttribute>& all, std::size_t count, const auto& block_of) {
    for (std::size_t begin = 0; begin < count; begin += 7) {
      const std::size_t end = std::min(count, begin + 7);
      const std::vector<MeshAttribute> block = block_of(begin, end);
      ASSERT_EQ(block.size(), all.size());
      for (std::size_t a = 0; a < all.size(); ++a) {
        EXPECT_EQ(block[a].name, all[a].name);
        EXPECT_EQ(block[a].values, std::vector<double>(all[a].values.begin() + begin, all[a].values.begin() + end));
      }
    }
  };
  expect_same(whole.vertex, r.mesh.vertices.size(), [&](auto b, auto e) { return blocks.of_vertices(b, e); });
  expect_same(whole.face, r.mesh.faces.size(), [&](auto b, auto e) { return blocks.of_faces(b, e); });
  ASSERT_EQ(whole.vertex.back().name, "opening");
  for (std::size_t i = 0; i < r.openings.size(); ++i) {
    for (const Index v : r.openings[i].ring) EXPECT_EQ(whole.vertex.back().values[v], static_cast<double>(i + 1));
  }
}

}  // namespace
}  // namespace vmesh
