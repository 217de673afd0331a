#include "solid/core_improvement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "vmesh/mesh/volume_faces.h"

namespace vmesh {
namespace {

struct Filled {
  CoreSurface surface;
  Core core;

  Vec3 at(Index v) const {
    const auto fixed = static_cast<Index>(surface.mesh.vertices.size());
    return v < fixed ? surface.mesh.vertices[v] : core.added[v - fixed];
  }
  double six_volumes(const Tetrahedron& t) const {
    return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).dot(at(t[3]) - at(t[0]));
  }
  double shape(const Tetrahedron& t) const { return tetrahedron_shape({at(t[0]), at(t[1]), at(t[2]), at(t[3])}); }
  double worst() const {
    double least = 1;
    for (const Tetrahedron& t : core.tetrahedra) least = std::min(least, shape(t));
    return least;
  }
  double sum() const {
    double sum = 0;
    for (const Tetrahedron& t : core.tetrahedra) sum += six_volumes(t);
    return sum;
  }
  /// Faces of one cell alone, by sorted corners.
  std::map<Triangle, int> outside() const {
    std::map<Triangle, int> count;
    for (const Tetrahedron& t : core.tetrahedra) {
      for (const CellFace& face : faces_of(t)) {
        Triangle key = {face[0], face[1], face[2]};
        std::sort(key.begin(), key.end());
        ++count[key];
      }
    }
    std::erase_if(count, [](const auto& entry) { return entry.second != 1; });
    return count;
  }

  void take_surface_of_cells() {
    for (const Tetrahedron& t : core.tetrahedra) {
      for (const CellFace& face : faces_of(t)) {
        Triangle key = {face[0], face[1], face[2]};
        std::sort(key.begin(), key.end());
        if (outside().contains(key)) surface.mesh.faces.push_back({face[0], face[1], face[2]});
      }
    }
  }
};

/// `n` cells around the edge from (0, 0, -height) to (0, 0, height), out to radius 1.
Filled cells_around_an_edge(Index n, double height) {
  Filled filled;
  for (Index i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    filled.surface.mesh.vertices.emplace_back(std::cos(turn), std::sin(turn), 0);
  }
  filled.surface.mesh.vertices.insert(filled.surface.mesh.vertices.end(), {{0, 0, -height}, {0, 0, height}});
  for (Index i = 0; i < n; ++i) filled.core.tetrahedra.push_back({n, n + 1, i, (i + 1) % n});
  filled.take_surface_of_cells();
  return filled;
}

void expect_same_space(const Filled& before, const Filled& after) {
  EXPECT_EQ(after.outside(), before.outside());
  EXPECT_NEAR(after.sum(), before.sum(), 1e-12 * before.sum());  // rounding of a few terms
  for (const Tetrahedron& t : after.core.tetrahedra) EXPECT_GT(after.six_volumes(t), 0);
}

// Needles along a long edge are better cells without it.
TEST(CoreImprovement, RemovesEdges) {
  for (const Index n : {3u, 4u, 5u, 6u}) {
    const Filled before = cells_around_an_edge(n, 5);
    Filled after = before;
    ASSERT_GT(before.sum(), 0);
    improve_core(after.surface, after.core);
    expect_same_space(before, after);
    EXPECT_GT(after.worst(), 1.1 * before.worst()) << n;
  }
}

TEST(CoreImprovement, LeavesGoodCellsAlone) {
  const Filled before = cells_around_an_edge(5, 0.8);
  ASSERT_GT(before.worst(), 0.3);
  Filled after = before;
  improve_core(after.surface, after.core);
  EXPECT_EQ(after.core.tetrahedra, before.core.tetrahedra);
  EXPECT_TRUE(after.core.added.empty());
}

}  // namespace
}  // namespace vmesh
