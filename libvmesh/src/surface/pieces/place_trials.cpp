#include "surface/pieces/place_trials.h"

#include <algorithm>

#include "vmesh/core/ascending.h"
#include "vmesh/core/disjoint_sets.h"

namespace vmesh {
namespace {

// Radii: more than that of any draw, and what its edges need to become as long as elsewhere.
constexpr double kAround = 4;
// The first in the usual way of refining only: other ways take longer than growing anew.
constexpr int kDrawsFirst = 3;
// Unproven faces: where there are more, closing notches does not do, nor other ways of refining.
constexpr std::size_t kMostAtNotches = 1000, kMostForOtherWays = 100;

}  // namespace

PlaceTrials::PlaceTrials(PieceGrower& grower, const Grown& first, const RefinementGoal& goal, const Progress& progress,
                         int most_draws)
    : grower_(grower),
      first_(first),
      goal_(goal),
      poll_([this, &progress](std::string_view, double) { return !progress || progress("try", done_); }),
      most_draws_(most_draws),
      boxes_(first.pieces.size()),
      is_given_up_(first.pieces.size(), 0),
      remedy_{FinePlaces(grower.tubes().field(), goal.limit), {}} {
  const GatheredSurface& surface = first.surface;
  for (Index p = 0; p < boxes_.size(); ++p) {
    for (Index f = surface.first_face[p]; f < surface.first_face[p + 1]; ++f) {
      for (const Index v : surface.mesh.faces[f]) boxes_[p].extend(surface.mesh.vertices[v]);
    }
  }
}

bool PlaceTrials::run(const std::vector<UnprovenPlace>& unproven) {
  const std::vector<Group> groups = groups_of(unproven);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    done_ = static_cast<double>(g) / static_cast<double>(groups.size());
    try_group(groups[g]);
  }
  was_run_ = true;
  return !groups.empty();
}

std::vector<Index> PlaceTrials::changed_pieces() const {
  std::vector<Index> changed;
  for (const FinePlace& place : fine_places()) {
    for (const Index p : pieces_near(place.center)) changed.push_back(p);
  }
  sort_unique(changed);
  return changed;
}

std::vector<Index> PlaceTrials::pieces_near(const Vec3& place) const {
  const VesselField& field = grower_.tubes().field();
  const FieldSample s = field.sample_global(place);
  const double reach = kAround * field.relations().radius_at(s.cone, s.t);
  std::vector<Index> near;
  for (Index p = 0; p < boxes_.size(); ++p) {
    if (boxes_[p].squaredExteriorDistance(place) < reach * reach) near.push_back(p);
  }
  return near;
}

// Places that have pieces in common are tried together.
std::vector<PlaceTrials::Group> PlaceTrials::groups_of(const std::vector<UnprovenPlace>& unproven) const {
  DisjointSets joined(boxes_.size());
  std::vector<std::vector<Index>> near;
  for (const UnprovenPlace& place : unproven) {
    near.push_back(pieces_near(place.position));
    for (const Index p : near.back()) joined.join(near.back().front(), p);
  }
  std::vector<Index> number(boxes_.size(), kNone);
  std::vector<Group> groups;
  for (std::size_t i = 0; i < unproven.size(); ++i) {
    if (near[i].empty() || is_given_up_[near[i].front()]) continue;
    Index& n = number[joined.find(near[i].front())];
    if (n == kNone) {
      n = static_cast<Index>(groups.size());
      groups.emplace_back();
    }
    groups[n].places.push_back(unproven[i]);
    groups[n].pieces.insert(groups[n].pieces.end(), near[i].begin(), near[i].end());
  }
  for (Group& group : groups) sort_unique(group.pieces);
  return groups;
}

void PlaceTrials::try_group(const Group& group) {
  FinePlaces fine = remedy_.fine;
  std::optional<Trial> best;
  std::vector<UnprovenPlace> unproven = group.places;
  for (int draws = 0; draws <= most_draws_; ++draws) {
    if (draws > 0 && !fine.draw(unproven)) break;
    std::optional<Trial> trial = try_with(fine, group);
    if (trial && draws > kDrawsFirst) try_other_ways(*trial);
    if (trial && is_known(*trial)) trial.reset();
    if (trial) unproven = trial->outcome.unproven;
    if (trial && (!best || trial->outcome.unproven_faces() < best->outcome.unproven_faces())) best = std::move(trial);
    if (best && draws == kDrawsFirst) try_other_ways(*best);
    if (best && best->outcome.is_met()) break;
  }
  if (best) remedy_ = {best->fine, best->outcome.hard};
  if (best && best->outcome.is_met()) return;
  for (const Index p : group.pieces) is_given_up_[p] = 1;
}

// Whether it is proven with what the whole surface was not proven with.
bool PlaceTrials::is_known(const Trial& trial) const {
  return was_run_ && trial.outcome.is_met() && trial.outcome.hard == remedy_.hard && trial.fine == remedy_.fine;
}

// Nothing if it does not grow.
std::optional<PlaceTrials::Trial> PlaceTrials::try_with(const FinePlaces& fine, const Group& group) {
  const VesselField& field = grower_.tubes().field();
  std::optional<FinishedSurface> grown = grower_.grow_some(first_, group.pieces, fine.places(), poll_);
  if (!grown) return std::nullopt;
  RefinementOutcome outcome = refine_once(*grown, field, goal_, remedy_.hard, poll_);
  if (!outcome.is_met() && outcome.unproven_faces() <= kMostAtNotches) close_notches(outcome, field, goal_.limit);
  return Trial{fine, *std::move(grown), std::move(outcome)};
}

void PlaceTrials::try_other_ways(Trial& trial) {
  if (trial.outcome.unproven_faces() > kMostForOtherWays) return;
  trial.outcome = refine_in_other_ways(trial.grown, std::move(trial.outcome), grower_.tubes().field(), goal_, poll_);
}

}  // namespace vmesh
