#include "surface/proof/place_repair.h"

#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "vmesh/mesh/topology.h"

#include "grown_study.h"
#include "surface/proof/surface_excerpt.h"

namespace vmesh {
namespace {

using testing::goal_of;
using testing::kSilent;
using testing::long_fork;
using testing::Study;

using Point = std::array<double, 3>;

// Faces by the places of their corners, whatever the numbers.
std::set<std::array<Point, 3>> faces_of(const TriMesh& mesh) {
  std::set<std::array<Point, 3>> faces;
  for (const Triangle& f : mesh.faces) {
    std::array<Point, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.vertices[f[k]];
      corners[k] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.insert(corners);
  }
  return faces;
}

// Two tubes' length of an even surface, open at both ends of its only piece that has a junction.
FinishedSurface open_junction(Study& study) {
  Index junction = 0;
  while (study.first.pieces[junction].junctions == 0) ++junction;
  return *study.grower.grow_some(study.first, {junction}, {}, kSilent);
}

// Without a gap in which notches could be closed.
Centerline single_vessel() { return {{{{0, 0, -3}, 1}, {{0, 0, 3}, 0.8}}, {{0, 1}}}; }

TEST(SurfaceExcerpt, IsPutBackWhereItWas) {
  Study study(long_fork(), 0.05);
  const FinishedSurface before = open_junction(study);
  const Vec3 center = before.mesh.vertices[before.openings[0].ring[0]];
  FinishedSurface after = before;
  const SurfaceExcerpt excerpt = cut_out(before, center, 0.5, 1.5);
  ASSERT_GT(excerpt.surface.mesh.faces.size(), 10u);
  ASSERT_LT(excerpt.surface.mesh.faces.size(), before.mesh.faces.size());
  put_in(after, excerpt, excerpt.surface);
  EXPECT_EQ(faces_of(after.mesh), faces_of(before.mesh));
  EXPECT_EQ(after.mesh.vertices.size(), before.mesh.vertices.size());
  for (std::size_t o = 0; o < before.openings.size(); ++o) {
    const std::vector<Index>&was = before.openings[o].ring, &is = after.openings[o].ring;
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t j = 0; j < is.size(); ++j) EXPECT_EQ(after.mesh.vertices[is[j]], before.mesh.vertices[was[j]]);
  }
}

// Even where faces are longer than what is between what changes and the border.
TEST(SurfaceExcerpt, HoldsWhatIsNotToChange) {
  Study study(long_fork(), 0.05);
  const FinishedSurface whole = open_junction(study);
  const std::vector<Index>& ring = whole.openings[0].ring;
  const Vec3 center = whole.mesh.vertices[ring[0]];
  for (const double reach : {0.6, 1.5}) {
    const SurfaceExcerpt excerpt = cut_out(whole, center, 0.5, reach);
    std::vector<char> is_free(whole.mesh.vertices.size(), 1);
    for (const Index v : excerpt.surface.held) is_free[excerpt.vertex[v]] = 0;
    for (Index v = 0; v < excerpt.vertex.size(); ++v) {
      EXPECT_EQ(excerpt.surface.mesh.vertices[v], whole.mesh.vertices[excerpt.vertex[v]]);
      EXPECT_TRUE((excerpt.surface.mesh.vertices[v] - center).norm() <= 0.5 || !is_free[excerpt.vertex[v]]);
    }
    for (Index f = 0; f < whole.mesh.faces.size(); ++f) {
      if (std::binary_search(excerpt.face.begin(), excerpt.face.end(), f)) continue;
      for (const Index v : whole.mesh.faces[f]) {
        const bool is_in = std::find(excerpt.vertex.begin(), excerpt.vertex.end(), v) != excerpt.vertex.end();
        EXPECT_FALSE(is_in && is_free[v]);
      }
    }
  }
}

// Daughters that part at 12 degrees.
TEST(PlaceRepair, ProvesWhatRefiningLeaves) {
  const Centerline fork{{{{0, 0, -3}, 1}, {{0, 0, 0}, 1}, {{1.2, 0, 8}, 0.5}, {{-0.55, 0, 8}, 0.8}},
                        {{0, 1}, {1, 2}, {1, 3}}};
  Study study(fork, 0.05);
  const RefinementGoal goal = goal_of(0.05);
  RefinementOutcome outcome = refine_once(study.first.surface, study.field, goal, kSilent);
  ASSERT_FALSE(outcome.is_met());
  const RefinementOutcome before = outcome;
  repair_places(outcome, study.field, goal, {100, 200}, kSilent);
  EXPECT_TRUE(outcome.is_met());
  const FinishedSurface& surface = outcome.surface;
  EXPECT_TRUE(unproven_faces(surface.mesh, surface.binding, study.field, goal.limit).empty());
  EXPECT_TRUE(boundary_edges(surface.mesh).empty());
  EXPECT_TRUE(self_intersections(surface.mesh).empty());
  // Elsewhere it stays as it was: excerpts reach 5.8 radii from an unproven face.
  const std::set<std::array<Point, 3>> was = faces_of(before.surface.mesh), is = faces_of(surface.mesh);
  for (const std::array<Point, 3>& face : was) {
    const Vec3 p(face[0][0], face[0][1], face[0][2]);
    const bool is_near = std::any_of(before.unproven.begin(), before.unproven.end(),
                                     [&](const UnprovenPlace& place) { return (p - place.position).norm() < 7; });
    EXPECT_TRUE(is_near || is.contains(face));
  }
}

TEST(PlaceRepair, LeavesAloneWhatIsTooLarge) {
  Study study(single_vessel(), 0.05);
  RefinementOutcome outcome = refine_once(study.first.surface, study.field, goal_of(0.005, 0), kSilent);
  ASSERT_FALSE(outcome.is_met());
  const TriMesh before = outcome.surface.mesh;
  repair_places(outcome, study.field, goal_of(0.005, 0), {1, 1000}, kSilent);
  EXPECT_FALSE(outcome.is_met());
  EXPECT_EQ(outcome.surface.mesh.faces, before.faces);
}

TEST(PlaceRepair, CanBeCancelled) {
  Study study(single_vessel(), 0.05);
  RefinementOutcome outcome = refine_once(study.first.surface, study.field, goal_of(0.005, 0), kSilent);
  const Progress cancel = [](std::string_view, double) { return false; };
  EXPECT_THROW(repair_places(outcome, study.field, goal_of(0.005, 0), {1000, 1}, cancel), Cancelled);
}

}  // namespace
}  // namespace vmesh
