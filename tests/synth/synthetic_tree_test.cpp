#include "vmesh/synth/synthetic_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

struct Case {
  std::size_t vertices;
  std::uint64_t seed;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.vertices << " vertices, seed " << c.seed; }

// Node 0 is the root and node i + 1 hangs on segment i: the header's promise makes the tests short.
Index parent_of(const Centerline& tree, Index n) { return tree.segment(n - 1).a; }

std::vector<std::vector<Index>> children_of(const Centerline& tree) {
  std::vector<std::vector<Index>> children(tree.nodes().size());
  for (const auto& s : tree.segments()) children[s.a].push_back(s.b);
  return children;
}

Vec3 direction(const Centerline& tree, Index segment) {
  return (tree.node(tree.segment(segment).b).position - tree.node(tree.segment(segment).a).position).normalized();
}

double angle_deg(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi;
}

std::size_t end_count(const Centerline& tree) {
  std::size_t ends = 0;
  for (Index n = 1; n < tree.nodes().size(); ++n) ends += tree.degree(n) == 1;
  return ends;
}

// Distance of two segments by minimising over the square of their parameters: nothing like the library's own way.
double distance_by_descent(const Centerline& tree, Index i, Index j) {
  const Vec3 p = tree.point_at(i, 0), u = tree.point_at(i, 1) - p;
  const Vec3 q = tree.point_at(j, 0), v = tree.point_at(j, 1) - q;
  double s = 0.5, t = 0.5;
  for (int k = 0; k < 100; ++k) {
    s = std::clamp((q + t * v - p).dot(u) / u.squaredNorm(), 0.0, 1.0);
    t = std::clamp((p + s * u - q).dot(v) / v.squaredNorm(), 0.0, 1.0);
  }
  return (p + s * u - q - t * v).norm();
}

// Nodes within path length `limit` of `from`.
std::vector<bool> near_nodes(const Centerline& tree, Index from, double limit) {
  std::vector<bool> near(tree.nodes().size(), false);
  std::vector<std::pair<Index, double>> stack{{from, 0.0}};
  near[from] = true;
  while (!stack.empty()) {
    const auto [n, path] = stack.back();
    stack.pop_back();
    for (const Index s : tree.incident_segments(n)) {
      const Index m = tree.other_node(s, n);
      const double there = path + tree.length(s);
      if (near[m] || there > limit) continue;
      near[m] = true;
      stack.push_back({m, there});
    }
  }
  return near;
}

class SyntheticTree : public ::testing::TestWithParam<Case> {
 protected:
  Centerline tree_ = synthetic_tree({GetParam().vertices, GetParam().seed});
};

TEST_P(SyntheticTree, IsOneTreeWithExactlyTheVerticesAskedFor) {
  EXPECT_EQ(tree_.nodes().size(), GetParam().vertices);
  EXPECT_EQ(tree_.segments().size(), GetParam().vertices - 1);
  EXPECT_EQ(tree_.component_count(), 1u);
  EXPECT_EQ(tree_.cycle_rank(), 0u);
  for (Index n = 1; n < tree_.nodes().size(); ++n) {
    ASSERT_EQ(tree_.segment(n - 1).b, n);
    ASSERT_LT(parent_of(tree_, n), n);
    ASSERT_LE(tree_.degree(n), 3u);
  }
}

TEST_P(SyntheticTree, FollowsMurraysLawAtEveryFork) {
  const auto cube = [](double r) { return r * r * r; };
  const auto children = children_of(tree_);
  for (Index n = 0; n < tree_.nodes().size(); ++n) {
    if (children[n].size() < 2) continue;
    double sum = 0;
    for (const Index c : children[n]) sum += cube(tree_.node(c).radius);
    ASSERT_NEAR(sum, cube(tree_.node(n).radius), 1e-12 * sum) << "node " << n;
  }
}

TEST_P(SyntheticTree, GetsThinnerDownstreamAndGently) {
  for (Index n = 1; n < tree_.nodes().size(); ++n) {
    const double above = tree_.node(parent_of(tree_, n)).radius;
    ASSERT_GT(tree_.node(n).radius, 0);
    ASSERT_LE(tree_.node(n).radius, above * (1 + 1e-12)) << "node " << n;
    if (tree_.degree(parent_of(tree_, n)) != 2) continue;
    ASSERT_GT(tree_.node(n).radius, 0.6 * above) << "node " << n;
  }
}

TEST_P(SyntheticTree, TurnsGently) {
  for (Index n = 1; n < tree_.nodes().size(); ++n) {
    if (tree_.degree(n) != 2) continue;
    const Index next = tree_.incident_segments(n)[1];
    ASSERT_LT(angle_deg(direction(tree_, n - 1), direction(tree_, next)), 40) << "node " << n;
  }
}

TEST_P(SyntheticTree, ForksAtWideAngles) {
  const auto children = children_of(tree_);
  for (Index n = 1; n < tree_.nodes().size(); ++n) {
    if (children[n].size() != 2) continue;
    const Vec3 a = direction(tree_, children[n][0] - 1), b = direction(tree_, children[n][1] - 1);
    ASSERT_GT(angle_deg(a, b), 60) << "node " << n;
    ASSERT_LT(angle_deg(a, b), 120) << "node " << n;
    ASSERT_GT(a.dot(direction(tree_, n - 1)), -0.2) << "node " << n;
    ASSERT_GT(b.dot(direction(tree_, n - 1)), -0.2) << "node " << n;
  }
}

TEST_P(SyntheticTree, VesselsThatAreNotNeighboursKeepApart) {
  const auto radius = [&](Index s) { return std::max(tree_.radius_at(s, 0), tree_.radius_at(s, 1)); };
  for (Index i = 0; i < tree_.segments().size(); ++i) {
    for (Index j = i + 1; j < tree_.segments().size(); ++j) {
      const double reach = radius(i) + radius(j);
      const Vec3 between = tree_.point_at(i, 0.5) - tree_.point_at(j, 0.5);
      if (between.norm() > reach + 0.5 * (tree_.length(i) + tree_.length(j))) continue;
      if (distance_by_descent(tree_, i, j) > reach) continue;
      const auto from_a = near_nodes(tree_, tree_.segment(i).a, 2 * reach);
      const auto from_b = near_nodes(tree_, tree_.segment(i).b, 2 * reach);
      const auto [a, b] = std::pair(tree_.segment(j).a, tree_.segment(j).b);
      ASSERT_TRUE(from_a[a] || from_a[b] || from_b[a] || from_b[b]) << "segments " << i << " and " << j << " touch";
    }
  }
}

TEST_P(SyntheticTree, StaysInTheRegion) {
  for (const auto& node : tree_.nodes()) {
    for (int d = 0; d < 3; ++d) {
      ASSERT_TRUE(in_synthetic_tree_region(node.position + node.radius * Vec3::Unit(d)));
      ASSERT_TRUE(in_synthetic_tree_region(node.position - node.radius * Vec3::Unit(d)));
    }
  }
}

TEST_P(SyntheticTree, IsTheSameEveryTime) {
  const Centerline again = synthetic_tree({GetParam().vertices, GetParam().seed});
  for (Index n = 0; n < tree_.nodes().size(); ++n) {
    ASSERT_EQ(tree_.node(n).position, again.node(n).position);
    ASSERT_EQ(tree_.node(n).radius, again.node(n).radius);
  }
  for (Index s = 0; s < tree_.segments().size(); ++s) ASSERT_EQ(tree_.segment(s).a, again.segment(s).a);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SyntheticTree,
                         ::testing::Values(Case{2, 1}, Case{3, 5}, Case{9, 1}, Case{10, 2}, Case{20, 3}, Case{50, 1},
                                           Case{119, 1}, Case{119, 2}, Case{119, 3}, Case{119, ~0ull}, Case{500, 4},
                                           Case{777, 0}, Case{1560, 1}, Case{1560, 2}, Case{1560, 3}, Case{1560, 12345},
                                           Case{8000, 1}),
                         [](const auto& tree) {
                           return std::to_string(tree.param.vertices) + "Seed" + std::to_string(tree.param.seed);
                         });

TEST(SyntheticTreeStatistics, AreThoseOfThePapersTrees) {
  const Centerline small = synthetic_tree({119, 1}), large = synthetic_tree({1560, 1});
  EXPECT_NEAR(static_cast<double>(end_count(small)), 16, 5);
  EXPECT_NEAR(static_cast<double>(end_count(large)), 200, 30);
  EXPECT_NEAR(small.length_in_radii(), 250, 60);
  EXPECT_NEAR(large.length_in_radii(), 4200, 500);
  EXPECT_NEAR(large.node(0).radius, 6.5, 0.3);
}

TEST(SyntheticTreeStatistics, FillsTheRegion) {
  // No sizeable part of the region is far from every vessel.
  const Centerline tree = synthetic_tree({1560, 1});
  std::size_t inside = 0, fed = 0;
  for (double x = -105; x <= 105; x += 15) {
    for (double y = -75; y <= 75; y += 15) {
      for (double z = -65; z <= 65; z += 15) {
        const Vec3 p(x, y, z);
        if (!in_synthetic_tree_region(p)) continue;
        ++inside;
        fed += std::any_of(tree.nodes().begin(), tree.nodes().end(),
                           [&](const auto& node) { return (node.position - p).norm() < 20; });
      }
    }
  }
  EXPECT_GT(inside, 200u);
  EXPECT_GT(static_cast<double>(fed), 0.9 * static_cast<double>(inside));
}

TEST(SyntheticTreeStatistics, DifferWithTheSeed) {
  EXPECT_NE(synthetic_tree({119, 1}).node(118).position, synthetic_tree({119, 2}).node(118).position);
}

// FNV-1a of all coordinates, radii and parents: the promise that every platform gives the same tree. When the
// generator is changed on purpose, this number changes too.
TEST(SyntheticTreeStatistics, KeepTheirBytes) {
  const Centerline tree = synthetic_tree({1560, 1});
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](double value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  };
  for (const auto& node : tree.nodes()) {
    for (int d = 0; d < 3; ++d) add(node.position[d]);
    add(node.radius);
  }
  for (const auto& s : tree.segments()) add(s.a);
  EXPECT_EQ(hash, 16779087076400812411u);
}

TEST(SyntheticTreeOptions, OutOfRangeAreRejected) {
  EXPECT_THROW(synthetic_tree({0, 1}), InvalidInput);
  EXPECT_THROW(synthetic_tree({1, 1}), InvalidInput);
  EXPECT_THROW(synthetic_tree({10'000'001, 1}), InvalidInput);
}

}  // namespace
}  // namespace vmesh
