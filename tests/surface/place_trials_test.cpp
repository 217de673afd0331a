#include "surface/pieces/place_trials.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "grown_study.h"
#include "random_vessels.h"
#include "surface/proof/place_repair.h"

namespace vmesh {
namespace {

using testing::goal_of;
using testing::kSilent;
using testing::long_fork;
using testing::Study;

bool is_before(const Vec3& p, const Vec3& q) { return std::tie(p.x(), p.y(), p.z()) < std::tie(q.x(), q.y(), q.z()); }

TEST(PieceGrower, GrowsSomePiecesAsInTheWhole) {
  Study study(long_fork(), 0.05);
  ASSERT_GT(study.first.pieces.size(), 2u);
  std::vector<Vec3> all = study.first.surface.mesh.vertices;
  std::sort(all.begin(), all.end(), is_before);
  for (Index p = 0; p < study.first.pieces.size(); ++p) {
    const auto some = study.grower.grow_some(study.first, {p}, {}, kSilent);
    ASSERT_TRUE(some);
    EXPECT_EQ(some->mesh.faces.size(), study.first.surface.first_face[p + 1] - study.first.surface.first_face[p]);
    for (const Vec3& v : some->mesh.vertices) EXPECT_TRUE(std::binary_search(all.begin(), all.end(), v, is_before));
    EXPECT_FALSE(some->openings.empty());
  }
}

TEST(PieceGrower, ChangesOnlySomePieces) {
  Study study(long_fork(), 0.05);
  Index junction = 0;
  while (study.first.pieces[junction].junctions == 0) ++junction;
  const FinePlace fine{{0, 0.9, 1}, 1, 0.1};
  const Grown anew = study.grower.grow_anew(study.first, {junction}, {fine});
  const GatheredSurface &before = study.first.surface, &after = anew.surface;
  ASSERT_EQ(anew.pieces.size(), study.first.pieces.size());
  for (Index p = 0; p < anew.pieces.size(); ++p) {
    const std::vector<Vec3> old(before.mesh.vertices.begin() + before.first_vertex[p],
                                before.mesh.vertices.begin() + before.first_vertex[p + 1]);
    const std::vector<Vec3> now(after.mesh.vertices.begin() + after.first_vertex[p],
                                after.mesh.vertices.begin() + after.first_vertex[p + 1]);
    if (p == junction) {
      EXPECT_GT(now.size(), old.size());
    } else {
      EXPECT_EQ(now, old);
    }
  }
}

TEST(PlaceTrials, FindWhatTheWholeSurfaceNeeds) {
  Study study(testing::plausible_tree(7011), 0.01);
  const RefinementGoal goal = goal_of(0.01);
  const RefinementOutcome usual = refine_once(study.first.surface, study.field, goal, kSilent);
  ASSERT_FALSE(usual.is_met());
  PlaceTrials trials(study.grower, study.first, goal, kSilent);
  ASSERT_TRUE(trials.run(usual.unproven));
  const Grown anew = study.grower.grow_anew(study.first, trials.changed_pieces(), trials.fine_places());
  RefinementOutcome refined = refine_once(anew.surface, study.field, goal, kSilent);
  if (!refined.is_met()) repair_places(refined, study.field, goal, {1000, 1000}, kSilent);
  EXPECT_TRUE(refined.is_met());
  // Finer there only.
  EXPECT_LT(static_cast<double>(refined.surface.mesh.vertices.size()),
            1.2 * static_cast<double>(usual.surface.mesh.vertices.size()));
}

TEST(PlaceTrials, LeavePlacesAloneForWhichNothingDoes) {
  Study study(long_fork(), 0.05);
  const RefinementGoal without_refining = goal_of(0.005, 0);
  const std::vector<UnprovenPlace> unproven = {{{0, 0.9, 1}, 1}};
  PlaceTrials trials(study.grower, study.first, without_refining, kSilent, 1);
  EXPECT_TRUE(trials.run(unproven));
  EXPECT_FALSE(trials.run(unproven));
}

TEST(PlaceTrials, CanBeCancelled) {
  Study study(long_fork(), 0.05);
  const RefinementGoal goal = goal_of(0.05);
  const Progress cancel = [](std::string_view, double) { return false; };
  PlaceTrials trials(study.grower, study.first, goal, cancel);
  EXPECT_THROW(trials.run({{{0, 0.9, 1}, 1}}), Cancelled);
}

}  // namespace
}  // namespace vmesh
