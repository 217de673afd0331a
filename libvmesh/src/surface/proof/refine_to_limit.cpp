#include "surface/proof/refine_to_limit.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "surface/check/error_limit.h"

namespace vmesh {
namespace {

constexpr double kNearOpening = 1.5;  // radii: faces there have a corner on its ring

}  // namespace

std::size_t RefinementOutcome::unproven_faces() const {
  return std::accumulate(unproven.begin(), unproven.end(), std::size_t{0},
                         [](std::size_t sum, const UnprovenPlace& place) { return sum + place.faces; });
}

RefinementOutcome refine_once(FinishedSurface surface, const VesselField& field, const RefinementGoal& goal,
                              const Progress& progress) {
  RefinementOutcome outcome{std::move(surface), {}, {}, {}};
  note_unproven(outcome, refine(outcome.surface, field, goal, progress));
  return outcome;
}

void note_unproven(RefinementOutcome& outcome, std::vector<Index> faces) {
  outcome.error = {faces.size(), places_of(outcome.surface.mesh, faces), {}};
  outcome.faces = std::move(faces);
  outcome.unproven = outcome.error.unproven_places;
  std::erase_if(outcome.unproven, [&](const UnprovenPlace& place) {
    const std::vector<Opening>& openings = outcome.surface.openings;
    return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
      return (place.position - opening.center).norm() < kNearOpening * opening.radius;
    });
  });
}

}  // namespace vmesh
