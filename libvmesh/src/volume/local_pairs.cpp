#include "volume/local_pairs.h"

#include "volume/sphere_chain.h"

namespace vmesh {
namespace {

// Segments at a node from which on it pays to cache what the node was joined to; idle 6 to 11.
constexpr std::size_t kManySegments = 8;

}  // namespace

PairSet pairs_in_touch(const SphereChain& chain, const Touch& touch,
                       const std::function<void(Index, Index)>& visit_next) {
  PairSet touching(chain.size());
  const auto note = [&](Index p, Index q) {
    const bool touches = p == q || chain.are_in_one_fan(p, q) || chain.touch(p, q, touch);
    if (touches && p != q && !chain.are_in_one_fan(p, q)) touching.insert(p, q);
    return touches;
  };
  chain.visit_touching_ends(touch, note);
  for (Index p = 0; p < chain.size(); ++p) {
    chain.visit_next(p, [&](Index q) {
      note(p, q);
      if (chain.is_in_fan_of(q, p)) return;  // what is next to both is in the fan or has been visited
      chain.visit_next(p, [&](Index other) { note(q, other); });
    });
  }
  for (std::size_t n = 0; n < touching.pairs().size(); ++n) {
    const auto [p, q] = touching.pairs()[n];
    chain.visit_next_pairs(p, q, [&](Index next_p, Index next_q) {
      if (!note(next_p, next_q) && visit_next) visit_next(next_p, next_q);
    });
  }
  return touching;
}

void SegmentPairs::join(Index p, Index q) {
  if (chain_.segments(p).size() < chain_.segments(q).size()) std::swap(p, q);
  for (const Index j : chain_.segments(q)) join_one(p, j);
}

void SegmentPairs::join_one(Index p, Index j) {
  if (p < chain_.nodes() && chain_.fans().hub_of(j) == p) return;  // all share the hub
  const auto segments = chain_.segments(p);
  if (segments.size() > kManySegments && !joined_.insert(p, chain_.size() + j)) return;
  for (const Index i : segments) {
    if (i != j && !chain_.fans().are_in_one(i, j)) pairs_.insert(i, j);
  }
}

void SegmentPairs::join_at_nodes() {
  for (Index n = 0; n < chain_.nodes(); ++n) {
    for (const Index j : chain_.segments(n)) {
      if (chain_.fans().hub_of(j) != n) join_one(n, j);
    }
  }
}

void SegmentPairs::join_all(const PairSet& spheres) {
  for (const auto& [p, q] : spheres.pairs()) join(p, q);
}

PairSet local_segments(const SphereChain& chain, const PairSet& touching) {
  SegmentPairs segments(chain);
  segments.join_at_nodes();
  segments.join_all(touching);
  return segments.take();
}

LocalSegments local_pairs(const Centerline& centerline, const Touch& touch) {
  const SphereChain chain(centerline, sphere_spacing(touch));
  return {chain.fans(), local_segments(chain, pairs_in_touch(chain, touch))};
}

}  // namespace vmesh
