#include "volume/contact_looks.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "vmesh/core/ascending.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

// Rounds whose vessels are kept, and cones in all of them together. Measured on VascularNetworkFixed-002 and
// Neuron_3_random_walker.
constexpr std::size_t kMostRounds = 12, kMostCones = 1'000'000;
// Of the cones: where more have changed, all are looked at.
constexpr double kMostChanged = 0.5;

bool are_equal(const CenterlineNode& a, const CenterlineNode& b) {
  return a.position == b.position && a.radius == b.radius;
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

std::vector<ContactPair> ContactLooks::all_pairs(const Centerline& vessels) const {
  return find_contact_pairs(ConeRelations(vessels, question_.blend), question_.gap);
}

const std::vector<ContactPair>& ContactLooks::look(DividedCenterline vessels, std::size_t round) {
  round = std::min(round, rounds_kept(vessels.centerline.segments().size()) - 1);
  if (known_.size() <= round) known_.resize(round + 1);
  const Known* nearest = nullptr;
  Differences least;
  for (const std::size_t r : {last_, round}) {
    if (r >= known_.size() || !known_[r] || nearest == &*known_[r]) continue;
    Differences other = differences(known_[r]->vessels, vessels);
    if (nearest && other.new_cones.size() >= least.new_cones.size()) continue;
    nearest = &*known_[r];
    least = std::move(other);
  }
  std::vector<ContactPair> pairs = nearest ? updated(*nearest, vessels, least) : all_pairs(vessels.centerline);
  known_[round] = {std::move(vessels), std::move(pairs)};
  last_ = round;
  return known_[round]->pairs;
}

std::vector<ContactPair> ContactLooks::updated(const Known& before, const DividedCenterline& after,
                                               const Differences& differences) const {
  const std::size_t changed = differences.old_cones.size() + differences.new_cones.size();
  if (static_cast<double>(changed) > kMostChanged * static_cast<double>(after.pieces.size()))
    return all_pairs(after.centerline);
  const ConeAxes axes(after.centerline);
  std::vector<char> is_seen(axes.cone_count(), 0);
  std::vector<ContactPair> pairs;
  if (changed > 0) {
    const RelationExcerpts excerpts(axes, question_);
    const ConeAxes old_axes(before.vessels.centerline);
    std::vector<Index> near;
    for (const Index c : differences.old_cones) excerpts.add_near(grown_box(old_axes, c, question_), near);
    for (const Index c : differences.new_cones) excerpts.add_near(grown_box(axes, c, question_), near);
    sort_unique(near);
    const std::vector<Index> seen = excerpts.influenced_by(near);
    for (const Index c : seen) is_seen[c] = 1;
    const RelationExcerpt part = excerpts.take(seen);
    pairs = find_contact_pairs_of(ConeRelations(part.centerline, question_.blend), question_.gap, part.is_near);
    for (ContactPair& pair : pairs) {
      pair.i = part.cone[pair.i];
      pair.j = part.cone[pair.j];
    }
  }
  for (ContactPair pair : before.pairs) {
    pair.i = differences.new_number[pair.i];
    pair.j = differences.new_number[pair.j];
    if (pair.i != kNone && pair.j != kNone && !is_seen[pair.i] && !is_seen[pair.j]) pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const ContactPair& a, const ContactPair& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  number_regions(axes, pairs);
  return pairs;
}

double ContactLooks::distance_to_others(const Vec3& p, Index cone, double limit) const {
  const ConeAxes axes(known_[last_]->vessels.centerline);
  const RelationExcerpts excerpts(axes, question_);
  std::vector<Index> near = {cone};
  excerpts.add_near({p.array() - limit, p.array() + limit}, near);
  sort_unique(near);
  const RelationExcerpt part = excerpts.take_alone(near);
  return VesselField(part.centerline, question_.blend).distance_to_others(p, place_in(part.cone, cone), limit);
}

}  // namespace vmesh
