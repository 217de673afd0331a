#include "fit/closest_walk.h"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace vmesh::fitting {
namespace {

/// A grid of `count` squares each way on a shallow bowl, each cut into two triangles; square (i, j) has the faces
/// 2 (i count + j) and one more.
TriMesh bowl(int count) {
  TriMesh mesh;
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= count; ++j) {
      const double x = 2.0 * i / count - 1, y = 2.0 * j / count - 1;
      mesh.vertices.emplace_back(x, y, 0.1 * (x * x + y * y));
    }
  }
  const auto number = [&](int i, int j) { return static_cast<Index>(i * (count + 1) + j); };
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      mesh.faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      mesh.faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  return mesh;
}

std::vector<Triangle> faces_across(const TriMesh& mesh) {
  std::map<std::pair<Index, Index>, Index> face_of;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) face_of[{mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]}] = f;
  }
  std::vector<Triangle> across(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = face_of.find({mesh.faces[f][(i + 1) % 3], mesh.faces[f][i]});
      across[f][i] = found == face_of.end() ? kNone : found->second;
    }
  }
  return across;
}

class Walk : public ::testing::Test {
 protected:
  std::optional<ClosestPoint> from(Index start, const Vec3& p) const {
    return walk_closer(index_, p, start, [&](Index f) -> const Triangle& { return across_[f]; });
  }
  static constexpr int kCount = 12;
  TriMesh mesh_ = bowl(kCount);
  ClosestPointIndex index_{mesh_};
  std::vector<Triangle> across_ = faces_across(mesh_);
};

TEST_F(Walk, FindsTheClosestPointOfAShallowBowlFromEveryFaceNearby) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1, 1), height(-0.2, 0.3);
  std::uniform_int_distribution<int> aside(-2, 2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(place(random), place(random), height(random));
    const ClosestPoint closest = index_.closest(p);
    const auto square = static_cast<int>(closest.face / 2);
    const int row = std::clamp(square / kCount + aside(random), 0, kCount - 1);
    const int column = std::clamp(square % kCount + aside(random), 0, kCount - 1);
    const auto found = from(static_cast<Index>(2 * (row * kCount + column)), p);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, closest.distance, 1e-12);
    EXPECT_NEAR((found->point - p).norm(), found->distance, 1e-12);
  }
}

TEST_F(Walk, PassesACornerThatSeveralFacesShare) {
  // Above a vertex all six faces around it are equally near; one beyond them is the closest of a point beside it.
  const Vec3& corner = mesh_.vertices[5 * (kCount + 1) + 5];
  for (const Vec3& aside : {Vec3(0.01, 0.03, 0.2), Vec3(-0.02, -0.01, 0.2), Vec3(0.03, -0.02, 0.2)}) {
    const auto found = from(2 * (4 * kCount + 4), corner + aside);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, index_.closest(corner + aside).distance, 1e-12);
  }
}

TEST_F(Walk, StopsAtTheBorder) {
  const Vec3 beyond(1.5, 0.2, 0);
  const auto found = from(2 * (kCount - 3) * kCount + kCount, beyond);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->point.x(), 1, 1e-12);
}

TEST(ClosestWalk, GivesUpALongWay) {
  const TriMesh mesh = bowl(60);
  const ClosestPointIndex index(mesh);
  const std::vector<Triangle> across = faces_across(mesh);
  EXPECT_FALSE(walk_closer(index, Vec3(0.9, 0.9, 0), 0, [&](Index f) -> const Triangle& { return across[f]; }));
}

}  // namespace
}  // namespace vmesh::fitting
