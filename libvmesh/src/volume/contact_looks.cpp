#include "volume/contact_looks.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/volume/cone_relations.h"

namespace vmesh {
namespace {

// Rounds whose vessels are kept, and cones in all of them together. Measured on VascularNetworkFixed-002 and
// Neuron_3_random_walker.
constexpr std::size_t kMostRounds = 100, kMostCones = 1'000'000;
// Of the cones: where more have changed, or may be influenced by that, all are looked at.
constexpr double kMostChanged = 0.5;
// Mean radii along the graph over which a reduced blend grows back. Derived: 1 / kShareGrowth (segment_locality.cpp),
// and what rounding may make of it.
constexpr double kSharesReturn = 4.001;

bool is_less_rounded(const ConeRelations& cones, Index cone) {
  return cones.rounding_at(cone, 0) < 1 || cones.rounding_at(cone, 1) < 1;
}

bool are_equal(const CenterlineNode& a, const CenterlineNode& b) {
  return a.position == b.position && a.radius == b.radius;
}

// Whether the blend is reduced where those cones of a part of which everything is known end.
bool is_reduced_at_ends(const Centerline& vessels, const RelationExcerpt& part, const ConeRelations& relations) {
  for (Index c = 0; c < part.cone.size(); ++c) {
    if (!part.is_near[c] || !is_less_rounded(relations, c)) continue;
    if (part.cone[c] >= vessels.segments().size()) continue;  // an isolated node
    const auto& [a, b] = vessels.segment(part.cone[c]);
    const bool inner = std::ranges::all_of(std::array{a, b}, [&](Index n) {
      return std::ranges::all_of(vessels.incident_segments(n), [&](Index s) {
        const Index other = place_in(part.cone, s);
        return other != kNone && part.is_near[other];
      });
    });
    if (!inner) return true;
  }
  return false;
}

}  // namespace

// Both list their pieces along every segment of the same centerline, and have the same isolated nodes.
ContactLooks::Differences ContactLooks::differences(const DividedCenterline& before, const DividedCenterline& after) {
  Differences result;
  const ConeAxes old_axes(before.centerline), new_axes(after.centerline);
  result.new_number.assign(old_axes.cone_count(), kNone);
  const auto compare = [&](Index old_cone, Index new_cone) {
    const Centerline &o = before.centerline, &n = after.centerline;
    const bool same = are_equal(o.node(old_axes.first_node(old_cone)), n.node(new_axes.first_node(new_cone))) &&
                      are_equal(o.node(old_axes.last_node(old_cone)), n.node(new_axes.last_node(new_cone)));
    if (same) {
      result.new_number[old_cone] = new_cone;
    } else {
      result.old_cones.push_back(old_cone);
      result.new_cones.push_back(new_cone);
    }
  };
  const auto key = [](const SegmentPiece& piece) { return std::tuple(piece.segment, piece.t_first, piece.t_last); };
  Index i = 0, j = 0;
  while (i < before.pieces.size() || j < after.pieces.size()) {
    if (j == after.pieces.size() || (i < before.pieces.size() && key(before.pieces[i]) < key(after.pieces[j]))) {
      result.old_cones.push_back(i++);
    } else if (i == before.pieces.size() || key(after.pieces[j]) < key(before.pieces[i])) {
      result.new_cones.push_back(j++);
    } else {
      compare(i++, j++);
    }
  }
  for (; i < old_axes.cone_count(); ++i, ++j) compare(i, j);
  return result;
}

std::size_t ContactLooks::rounds_kept(std::size_t cones) const {
  return std::clamp(kMostCones / std::max<std::size_t>(1, cones), std::size_t{2}, kMostRounds);
}

ContactLooks::Found ContactLooks::find_all(const Centerline& vessels) const {
  const ConeRelations cones(vessels, question_.blend);
  Found found{find_contact_pairs(cones, question_.gap), std::vector<char>(cones.cone_count(), 0)};
  for (Index c = 0; c < cones.cone_count(); ++c) found.less_rounded[c] = is_less_rounded(cones, c);
  return found;
}

const std::vector<ContactPair>& ContactLooks::look(DividedCenterline vessels, std::size_t round) {
  round = std::min(round, rounds_kept(vessels.centerline.segments().size()) - 1);
  if (known_.size() <= round) known_.resize(round + 1);
  const Known* nearest = nullptr;
  Differences least;
  for (const std::size_t r : {last_, round}) {
    if (at_all_ || r >= known_.size() || !known_[r] || nearest == &*known_[r]) continue;
    Differences other = differences(known_[r]->vessels, vessels);
    if (nearest && other.new_cones.size() >= least.new_cones.size()) continue;
    nearest = &*known_[r];
    least = std::move(other);
  }
  Found found = nearest ? updated(*nearest, vessels, least) : find_all(vessels.centerline);
  surroundings_.reset();
  known_[round] = {std::move(vessels), std::move(found)};
  last_ = round;
  return known_[round]->found.pairs;
}

// Looks around what has changed, farther where a change in the blend may extend beyond them. Returns false if that is
// hardly less than everything.
bool ContactLooks::find_around(const ConeAxes& axes, const ConeAxes& old_axes, const Differences& differences,
                               Found& found, std::vector<char>& is_seen) const {
  const RelationExcerpts excerpts(axes, question_, found.less_rounded);
  std::vector<Index> changed = differences.new_cones;  // and what was beside cones that have gone
  for (const Index c : differences.old_cones) excerpts.add_near(grown_box(old_axes, c, question_), changed);
  sort_unique(changed);
  const auto is_little = [&](const std::vector<Index>& cones) {
    return static_cast<double>(cones.size()) <= kMostChanged * axes.cone_count();
  };
  const std::vector<Index> influenced = excerpts.influenced_by(changed);
  if (!is_little(influenced)) return false;
  const bool was_reduced = std::ranges::any_of(influenced, [&](Index c) { return found.less_rounded[c] != 0; });
  if (!was_reduced && find_in(axes, excerpts.take(influenced), true, found, is_seen)) return true;
  const std::vector<Index> beyond = excerpts.influenced_by(changed, kSharesReturn);
  return is_little(beyond) && find_in(axes, excerpts.take(beyond), false, found, is_seen);
}

// Looks at a part. Returns false, and has found nothing, if the blend has to be whole at its ends but is not.
bool ContactLooks::find_in(const ConeAxes& axes, const RelationExcerpt& part, bool is_whole_at_ends, Found& found,
                           std::vector<char>& is_seen) const {
  const ConeRelations relations(part.centerline, question_.blend);
  if (is_whole_at_ends && is_reduced_at_ends(axes.centerline(), part, relations)) return false;
  found.pairs = find_contact_pairs_of(relations, question_.gap, part.is_near);
  for (ContactPair& pair : found.pairs) {
    pair.i = part.cone[pair.i];
    pair.j = part.cone[pair.j];
  }
  for (Index c = 0; c < part.cone.size(); ++c) {
    if (!part.is_near[c]) continue;
    is_seen[part.cone[c]] = 1;
    found.less_rounded[part.cone[c]] = is_less_rounded(relations, c);
  }
  return true;
}

ContactLooks::Found ContactLooks::updated(const Known& before, const DividedCenterline& after,
                                          const Differences& differences) const {
  const std::vector<Index>& changed = differences.new_cones;
  if (static_cast<double>(changed.size()) > kMostChanged * static_cast<double>(after.pieces.size()))
    return find_all(after.centerline);
  const ConeAxes axes(after.centerline);
  std::vector<char> is_seen(axes.cone_count(), 0);
  Found found{{}, is_seen};
  for (Index c = 0; c < differences.new_number.size(); ++c) {
    if (differences.new_number[c] != kNone)
      found.less_rounded[differences.new_number[c]] = before.found.less_rounded[c];
  }
  if (!(changed.empty() && differences.old_cones.empty()) &&
      !find_around(axes, ConeAxes(before.vessels.centerline), differences, found, is_seen))
    return find_all(after.centerline);
  for (ContactPair pair : before.found.pairs) {
    pair.i = differences.new_number[pair.i];
    pair.j = differences.new_number[pair.j];
    if (pair.i != kNone && pair.j != kNone && !is_seen[pair.i] && !is_seen[pair.j]) found.pairs.push_back(pair);
  }
  std::sort(found.pairs.begin(), found.pairs.end(),
            [](const ContactPair& a, const ContactPair& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  number_regions(axes, found.pairs);
  return found;
}

double ContactLooks::distance_to_others(const Vec3& p, Index cone, double limit) const {
  if (!surroundings_) surroundings_ = std::make_unique<Surroundings>(*known_[last_], question_);
  if (surroundings_->whole) return surroundings_->whole->distance_to_others(p, cone, limit);
  const RelationExcerpts& excerpts = surroundings_->excerpts;
  std::vector<Index> near = {cone};
  excerpts.add_near({p.array() - limit, p.array() + limit}, near);
  sort_unique(near);
  const RelationExcerpt part = excerpts.take_alone(near);
  surroundings_->taken += part.cone.size();
  if (surroundings_->taken > surroundings_->axes.cone_count())
    surroundings_->whole.emplace(surroundings_->axes.centerline(), question_.blend);
  const ConeRelations relations(part.centerline, question_.blend);
  const auto local = relations.local_cones(place_in(part.cone, cone));
  double least = limit;
  for (Index c = 0; c < part.cone.size(); ++c) {
    if (part.is_near[c] && !std::binary_search(local.begin(), local.end(), c))
      least = std::min(least, relations.sample_cone(p, c).distance);
  }
  return least;
}

}  // namespace vmesh
