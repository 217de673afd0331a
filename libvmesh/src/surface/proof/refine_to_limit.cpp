#include "surface/proof/refine_to_limit.h"

#include <algorithm>
#include <utility>

#include "surface/check/error_limit.h"
#include "surface/proof/notches.h"

namespace vmesh {
namespace {

constexpr double kReach = 1.5;  // of a hard place, in radii

// Takes the next way where one has failed. Returns whether there is any left.
bool take_next_ways(const VesselField& field, const std::vector<UnprovenPlace>& unproven,
                    std::vector<HardPlace>& hard) {
  bool any = false;
  std::vector<char> is_next(hard.size(), 0);
  for (const UnprovenPlace& place : unproven) {
    const auto it = std::find_if(hard.begin(), hard.end(), [&](const HardPlace& known) {
      return (place.position - known.center).norm() < known.reach;
    });
    if (it == hard.end()) {
      const FieldSample s = field.sample_global(place.position);
      hard.push_back({place.position, kReach * field.relations().radius_at(s.cone, s.t), 1});
      is_next.push_back(1);
      any = true;
    } else if (!std::exchange(is_next[it - hard.begin()], char{1}) && it->way + 1 < refinement_ways()) {
      ++it->way;
      any = true;
    }
  }
  return any;
}

}  // namespace

RefinedError refine_to_limit(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                             const Progress& progress) {
  const FinishedSurface first = surface;
  RefinedError best;
  std::vector<HardPlace> hard;
  for (bool is_first = true;; is_first = false) {
    FinishedSurface refined = first;
    const std::vector<Index> unproven = refine(refined, field, goal, hard, progress);
    ErrorSummary error;
    if (!unproven.empty() || !surface.openings.empty()) error = close_notches(refined, field, goal.limit);
    const bool any_way_left = take_next_ways(field, error.unproven_places, hard);
    const bool is_met = unproven.empty() || error.unproven_faces == 0;
    if (is_first || is_met || error.unproven_faces < best.summary.unproven_faces) {
      best = {std::move(error), is_met};
      surface = std::move(refined);
    }
    if (is_met || !any_way_left || goal.usual_way_only) return best;
  }
}

}  // namespace vmesh
