#include "surface/proof/refine_to_limit.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "surface/check/error_limit.h"
#include "surface/proof/notches.h"

namespace vmesh {
namespace {

constexpr double kReach = 1.5;        // of a hard place, in radii
constexpr double kNearOpening = 1.5;  // radii: faces there have a corner on its ring

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

void note_error(ErrorSummary error, RefinementOutcome& outcome) {
  outcome.error = std::move(error);
  outcome.unproven = outcome.error.unproven_places;
  std::erase_if(outcome.unproven, [&](const UnprovenPlace& place) {
    const std::vector<Opening>& openings = outcome.surface.openings;
    return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
      return (place.position - opening.center).norm() < kNearOpening * opening.radius;
    });
  });
}

}  // namespace

std::size_t RefinementOutcome::unproven_faces() const {
  return std::accumulate(unproven.begin(), unproven.end(), std::size_t{0},
                         [](std::size_t sum, const UnprovenPlace& place) { return sum + place.faces; });
}

RefinementOutcome refine_once(FinishedSurface surface, const VesselField& field, const RefinementGoal& goal,
                              std::vector<HardPlace> hard, const Progress& progress) {
  RefinementOutcome outcome{std::move(surface), std::move(hard), {}, {}};
  const std::vector<Index> unproven = refine(outcome.surface, field, goal, outcome.hard, progress);
  note_error({unproven.size(), places_of(outcome.surface.mesh, unproven), {}}, outcome);
  return outcome;
}

void close_notches(RefinementOutcome& outcome, const VesselField& field, const ErrorLimit& limit) {
  note_error(close_notches(outcome.surface, field, limit), outcome);
}

RefinementOutcome refine_in_other_ways(const FinishedSurface& surface, RefinementOutcome first,
                                       const VesselField& field, const RefinementGoal& goal, const Progress& progress) {
  RefinementOutcome best = std::move(first);
  std::vector<HardPlace> hard = best.hard;
  std::vector<UnprovenPlace> unproven = best.unproven;
  while (!best.is_met() && take_next_ways(field, unproven, hard)) {
    RefinementOutcome next = refine_once(surface, field, goal, hard, progress);
    if (!next.is_met()) close_notches(next, field, goal.limit);
    unproven = next.unproven;
    if (next.unproven_faces() < best.unproven_faces()) best = std::move(next);
  }
  return best;
}

}  // namespace vmesh
