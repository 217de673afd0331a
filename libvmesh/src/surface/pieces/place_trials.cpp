#include "surface/pieces/place_trials.h"

#include <algorithm>

#include "vmesh/core/ascending.h"
#include "vmesh/core/disjoint_sets.h"

#include "surface/proof/place_repair.h"

namespace vmesh {
namespace {

// Radii: more than that of any draw, and what its edges need to become as long as elsewhere.
constexpr double kAround = 4;
constexpr RepairEffort kRepair{60, 250};

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
      fine_(grower.tubes().field(), goal.limit) {
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
  FinePlaces last = fine_;
  std::optional<Trial> best;
  std::vector<UnprovenPlace> unproven = group.places;
  std::size_t in_vain = 0;
  for (int draws = 0; draws < most_draws_; ++draws) {
    FinePlaces fine = last;
    if (!draw(fine, unproven, in_vain)) break;
    std::optional<Trial> trial = try_with(fine, group);
    if (!trial || is_known(*trial)) {
      ++in_vain;
      continue;
    }
    in_vain = 0;
    last = fine;
    unproven = trial->unproven;
    if (!best || trial->unproven_faces < best->unproven_faces) best.emplace(*std::move(trial));
    if (best->unproven.empty()) break;
  }
  if (best) fine_ = best->fine;
  if (best && best->unproven.empty()) return;
  for (const Index p : group.pieces) is_given_up_[p] = 1;
}

// All places; where that was in vain, one of them after the other.
bool PlaceTrials::draw(FinePlaces& fine, const std::vector<UnprovenPlace>& unproven, std::size_t in_vain) {
  if (in_vain == 0) return fine.draw(unproven);
  bool any = false;
  for (std::size_t time = 0; time <= (in_vain - 1) / unproven.size(); ++time)
    any = fine.draw({unproven[(in_vain - 1) % unproven.size()]});
  return any;
}

// Whether it is proven with what the whole surface was not proven with.
bool PlaceTrials::is_known(const Trial& trial) const {
  return was_run_ && trial.unproven.empty() && trial.fine == fine_;
}

// Nothing if it does not grow.
std::optional<PlaceTrials::Trial> PlaceTrials::try_with(const FinePlaces& fine, const Group& group) {
  const VesselField& field = grower_.tubes().field();
  std::optional<FinishedSurface> grown = grower_.grow_some(first_, group.pieces, fine.places(), poll_);
  if (!grown) return std::nullopt;
  RefinementOutcome outcome = refine_once(*std::move(grown), field, goal_, poll_);
  if (!outcome.is_met()) repair_places(outcome, field, goal_, kRepair, poll_);
  return Trial{fine, outcome.unproven_faces(), std::move(outcome.unproven)};
}

}  // namespace vmesh
