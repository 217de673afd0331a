#include "vmesh/surface/branch_labels.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "vmesh/centerline/branches.h"
#include "vmesh/core/error.h"

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

}  // namespace
}  // namespace vmesh
