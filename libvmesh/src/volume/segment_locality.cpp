#include "volume/segment_locality.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <queue>
#include <unordered_map>
#include <utility>

#include "vmesh/core/box_tree.h"

#include "volume/sphere_chain.h"

namespace vmesh {
namespace {

// Opposite walls are rounded over a gap of 2 * blend smaller radii, and meet at half of it.
constexpr double kReach = 2;  // safe 1.4 to 2.8
// Vessels that part are local to each other as far as this blend reaches; if they were as far as a larger one does,
// many walls that part and come near again would be joined. A larger one ends there; safe 0.35 to 0.7.
constexpr double kMostBlend = 0.5;
// Of a gap: margin because spheres half a radius apart do not fill a cone (one_volume); safe 0.63 to 1.3.
constexpr double kSpare = 0.9;
// Growth of the blend's share per mean radius along the graph. With 1, errors at creases next to turns are harder to
// prove.
constexpr double kShareGrowth = 0.25;  // safe 0.17 to 0.35

// Pairs of spheres that face each other across a gap, around those that have come near again. Between these and the
// place where the vessels part, the gap has a maximum, which divides the pairs between the two.
class GapPairs {
 public:
  GapPairs(const Centerline& centerline, const SphereChain& chain, const PairSet& touching, const PairSet& local,
           const Touch& near_again, const Touch& wide)
      : chain_(chain), touching_(touching), near_(near_again), wide_(wide), local_of_(centerline.segments().size()) {
    for (const auto& [i, j] : local.pairs()) {
      local_of_[i].push_back(j);
      local_of_[j].push_back(i);
    }
  }

  void find(const PairSet& near_again) {
    for (const auto& [p, q] : near_again.pairs()) note(p, q);
    for (std::size_t n = 0; n < facing_.size(); ++n)
      chain_.visit_next_pairs(facing_[n].p, facing_[n].q, [this](Index p, Index q) { note(p, q); });
    divide();
  }

  /// Calls visit(p, q) for the pairs that are apart, and for adjacent ones that face each other obliquely.
  template <class Visit>
  void visit_apart(Visit&& visit) const {
    for (const Pair& pair : facing_) {
      if (pair.side != Side::apart) continue;
      visit(pair.p, pair.q);
      chain_.visit_next_pairs(pair.p, pair.q, [&](Index p, Index q) {
        const auto it = number_.find(key(p, q));
        if (it != number_.end() && it->second == kNone) visit(p, q);
      });
    }
  }

  /// Calls visit(p, q) for the pairs on either side of the border between parting and apart.
  template <class Visit>
  void visit_border(Visit&& visit) const {
    for (const Pair& pair : facing_) {
      const Side other = pair.side == Side::apart ? Side::parting : Side::apart;
      bool any = false;
      chain_.visit_next_pairs(pair.p, pair.q, [&](Index p, Index q) {
        const auto it = number_.find(key(p, q));
        any = any || (it != number_.end() && it->second != kNone && facing_[it->second].side == other);
      });
      if (any) visit(pair.p, pair.q);
    }
  }

 private:
  enum class Side { unknown, parting, apart };
  struct Pair {
    Index p, q;
    double gap;  // smaller radii
    Side side = Side::unknown;
  };

  static std::uint64_t key(Index p, Index q) {
    const auto [low, high] = std::minmax(p, q);
    return std::uint64_t{low} << 32 | high;
  }

  void note(Index p, Index q) {
    if (p == q || chain_.are_in_one_fan(p, q) || touching_.contains(p, q) || !chain_.touch(p, q, wide_)) return;
    const auto [it, is_new] = number_.try_emplace(key(p, q), kNone);
    if (!is_new || !is_outside(between(p, q), p) || !is_outside(between(p, q), q)) return;
    it->second = static_cast<Index>(facing_.size());
    facing_.push_back({p, q, chain_.gap(p, q) / std::min(chain_.radius(p), chain_.radius(q))});
  }

  // The middle of the gap.
  Vec3 between(Index p, Index q) const {
    const Vec3 across = (chain_.center(q) - chain_.center(p)).normalized();
    return chain_.center(p) + (chain_.radius(p) + chain_.gap(p, q) / 2) * across;
  }

  // Whether x is outside all vessels that are one volume with those of sphere p.
  bool is_outside(const Vec3& x, Index p) const {
    const auto is_outside_of = [&](Index segment) {
      bool outside = true;
      chain_.visit_spheres(segment, [&](Index q) {
        outside = outside && (chain_.center(q) - x).squaredNorm() > chain_.radius(q) * chain_.radius(q);
      });
      return outside;
    };
    const auto segments = chain_.segments(p);
    return std::ranges::all_of(segments, [&](Index segment) {
      const Index hub = chain_.fans().hub_of(segment);
      return is_outside_of(segment) && std::ranges::all_of(local_of_[segment], is_outside_of) &&
             (hub == kNone || !chain_.is_in_fan(x, hub));
    });
  }

  // Watershed by gap width, flooded from where vessels part and from where they are near again.
  void divide() {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto reach = [&](Index n, Side side) {
      facing_[n].side = side;
      open.emplace(facing_[n].gap, n);
    };
    for (Index n = 0; n < facing_.size(); ++n) {
      const Pair& pair = facing_[n];
      bool parts = false;
      chain_.visit_next_pairs(pair.p, pair.q, [&](Index p, Index q) {
        parts = parts || p == q || touching_.contains(p, q) ||
                (chain_.are_in_one_fan(p, q) && chain_.touch(p, q, wide_));  // within a fan, gaps only become wider
      });
      if (parts) {
        reach(n, Side::parting);
      } else if (chain_.touch(pair.p, pair.q, near_)) {
        reach(n, Side::apart);
      }
    }
    while (!open.empty()) {
      const Pair pair = facing_[open.top().second];
      open.pop();
      chain_.visit_next_pairs(pair.p, pair.q, [&](Index p, Index q) {
        const auto it = number_.find(key(p, q));
        if (it == number_.end() || it->second == kNone || facing_[it->second].side != Side::unknown) return;
        reach(it->second, pair.side);
      });
    }
  }

  const SphereChain& chain_;
  const PairSet& touching_;
  const Touch &near_, &wide_;
  std::vector<std::vector<Index>> local_of_;
  std::vector<Pair> facing_;
  std::unordered_map<std::uint64_t, Index> number_;  // index into facing_, or kNone, of every visited pair
};

// The share of the blend left to nodes next to gaps.
class Rounding {
 public:
  Rounding(const Centerline& centerline, const SphereChain& chain, double blend)
      : centerline_(centerline), chain_(chain), blend_(blend), share_(centerline.nodes().size(), 1.0) {}

  /// Limits the blend of two spheres so that it does not reach across their gap.
  void end_before_gap(Index p, Index q) { narrow(p, q, kReach); }
  /// Limits the blend of two spheres so that it does not join them.
  void keep_gap_open(Index p, Index q) { narrow(p, q, 1); }
  std::vector<double> take() { return std::move(share_); }

 private:
  // The thinner of the two decides.
  void narrow(Index p, Index q, double times) {
    if (blend_ == 0) return;
    const Index thinner = chain_.radius(p) <= chain_.radius(q) ? p : q;
    const double most = std::max(0.0, kSpare * chain_.gap(p, q) / (times * blend_ * chain_.radius(thinner)));
    const auto keep = [&](Index node) { share_[node] = std::min(share_[node], most); };
    if (thinner < chain_.nodes()) return keep(thinner);
    const auto& [a, b] = centerline_.segment(chain_.segments(thinner).front());
    keep(a);
    keep(b);
  }

  const Centerline& centerline_;
  const SphereChain& chain_;
  double blend_;
  std::vector<double> share_;
};

// Pairs of spheres reached from touching ones through pairs in touch only in the wider sense, and those of them that
// are near again. In between vessels are still local to each other, but the blend must not join them.
class WidePairs {
 public:
  WidePairs(const SphereChain& chain, const Touch& near_again, const Touch& wide)
      : chain_(chain), near_(near_again), wide_(wide) {}

  /// A pair that is not in touch, next to one that is.
  void note(Index p, Index q) {
    if (chain_.are_in_one_fan(p, q) || !chain_.touch(p, q, wide_)) return;
    (chain_.touch(p, q, near_) ? near_again_ : parting_).insert(p, q);
  }
  void extend(const PairSet& touching) {
    chain_.visit_touching_ends(wide_, [&](Index p, Index q) {
      if (!touching.contains(p, q)) note(p, q);
    });
    for (std::size_t n = 0; n < parting_.pairs().size(); ++n) {
      const auto [p, q] = parting_.pairs()[n];
      chain_.visit_next_pairs(p, q, [&](Index next_p, Index next_q) {
        if (next_p != next_q && !touching.contains(next_p, next_q)) note(next_p, next_q);
      });
    }
  }
  const PairSet& parting() const { return parting_; }
  const PairSet& near_again() const { return near_again_; }

 private:
  const SphereChain& chain_;
  const Touch &near_, &wide_;
  PairSet parting_, near_again_;
};

// Calls visit(i, j) for the pairs of segments whose boxes, grown by half the widest gap of `wide`, overlap.
template <class Visit>
void visit_near(const Centerline& centerline, const Touch& wide, Visit&& visit) {
  std::vector<Vec3> low, high;
  for (const auto& [a, b] : centerline.segments()) {
    const auto &from = centerline.node(a), &to = centerline.node(b);
    const double widest = std::max(from.radius, to.radius), reach = widest + wide.gap(widest, widest) / 2;
    low.push_back(from.position.cwiseMin(to.position).array() - reach);
    high.push_back(from.position.cwiseMax(to.position).array() + reach);
  }
  BoxTree(low, high).visit_pairs([&](Index i, Index j) {
    if ((low[i].array() <= high[j].array()).all() && (low[j].array() <= high[i].array()).all()) visit(i, j);
  });
}

bool are_near(const SphereChain& chain, Index i, Index j, const Touch& wide) {
  bool near = false;
  chain.visit_spheres(
      i, [&](Index p) { chain.visit_spheres(j, [&](Index q) { near = near || chain.touch(p, q, wide); }); });
  return near;
}

// Segments that are not local to each other but both local to a third, as where two thick ones come close along a thin
// one between them: in the third's queries they must not be blended either, or the boundary would have a step where
// locality ends.
void part_unrelated_segments(const Centerline& centerline, const SphereChain& chain, const Touch& wide,
                             SegmentLocality& locality) {
  std::vector<std::pair<Index, Index>> unrelated;
  visit_near(centerline, wide, [&](Index i, Index j) {
    const bool known =
        locality.are_one_volume(i, j) || locality.parting.contains(i, j) || locality.apart.contains(i, j);
    if (!known && are_near(chain, i, j, wide)) unrelated.emplace_back(i, j);
  });
  if (unrelated.empty()) return;
  std::vector<char> is_unrelated(centerline.segments().size(), 0);
  for (const auto& [i, j] : unrelated) is_unrelated[i] = is_unrelated[j] = 1;
  std::vector<std::vector<Index>> local(is_unrelated.size());
  for (Index s = 0; !locality.fans.empty() && s < local.size(); ++s) {
    const Index hub = locality.fans.hub_of(s);
    if (!is_unrelated[s] || hub == kNone) continue;
    for (const Index other : centerline.incident_segments(hub)) {
      if (other != s && locality.fans.hub_of(other) == hub) local[s].push_back(other);
    }
  }
  for (const PairSet* pairs : {&locality.local, &locality.parting}) {
    for (const auto& [i, j] : pairs->pairs()) {
      if (is_unrelated[i]) local[i].push_back(j);
      if (is_unrelated[j]) local[j].push_back(i);
    }
  }
  for (auto& row : local) std::sort(row.begin(), row.end());
  for (const auto& [i, j] : unrelated) {
    const std::vector<Index>& others = local[j];
    const bool meet =
        std::ranges::any_of(local[i], [&](Index c) { return std::binary_search(others.begin(), others.end(), c); });
    if (meet) locality.apart.insert(i, j);
  }
}

// Calls visit(p, q) for the pairs of spheres next to one of these, if segments that they belong to are unrelated.
template <class Visit>
void visit_unrelated(const SphereChain& chain, std::initializer_list<const PairSet*> related,
                     const SegmentLocality& locality, Visit&& visit) {
  const auto are_related = [&](Index i, Index j) {
    return i == j || locality.are_one_volume(i, j) || locality.parting.contains(i, j) || locality.apart.contains(i, j);
  };
  for (const PairSet* pairs : related) {
    for (const auto& [p, q] : pairs->pairs()) {
      chain.visit_next_pairs(p, q, [&](Index next_p, Index next_q) {
        const bool all_related = std::ranges::all_of(chain.segments(next_p), [&](Index i) {
          return std::ranges::all_of(chain.segments(next_q), [&](Index j) { return are_related(i, j); });
        });
        if (!all_related) visit(next_p, next_q);
      });
    }
  }
}

}  // namespace

std::vector<double> grow_shares(const Centerline& centerline, std::vector<double> share) {
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (Index n = 0; n < share.size(); ++n) {
    if (share[n] < 1) open.emplace(share[n], n);
  }
  if (open.empty()) return {};
  while (!open.empty()) {
    const auto [least, n] = open.top();
    open.pop();
    if (least > share[n]) continue;
    for (const Index s : centerline.incident_segments(n)) {
      const Index other = centerline.segment(s).a == n ? centerline.segment(s).b : centerline.segment(s).a;
      const double reached = least + kShareGrowth * centerline.length(s) / centerline.radius_at(s, 0.5);
      if (reached >= share[other]) continue;
      share[other] = reached;
      open.emplace(reached, other);
    }
  }
  return share;
}

SegmentLocality segment_locality(const Centerline& centerline, double blend) {
  SegmentLocality locality = segment_locality_at_gaps(centerline, blend);
  locality.rounding = grow_shares(centerline, std::move(locality.rounding));
  return locality;
}

SegmentLocality segment_locality_at_gaps(const Centerline& centerline, double blend) {
  const Touch one = one_volume(blend), near = near_again(blend), wide = farthest_local(std::min(blend, kMostBlend));
  const SphereChain chain(centerline, sphere_spacing(one));
  WidePairs wide_pairs(chain, near, wide);
  const PairSet touching = pairs_in_touch(chain, one, [&](Index p, Index q) { wide_pairs.note(p, q); });
  SegmentLocality locality{chain.fans(), {}, {}, {}, {}};
  locality.local = local_segments(chain, touching);
  wide_pairs.extend(touching);
  const PairSet &parting = wide_pairs.parting(), &near_again = wide_pairs.near_again();
  SegmentPairs near_gaps(chain), apart(chain);
  near_gaps.join_all(parting);
  apart.join_all(near_again);
  Rounding rounding(centerline, chain, blend);
  for (const auto& [p, q] : parting.pairs()) {
    if (chain.touch(p, q, one)) rounding.keep_gap_open(p, q);
  }
  if (!near_again.pairs().empty()) {
    GapPairs gap_pairs(centerline, chain, touching, locality.local, near, wide);
    gap_pairs.find(near_again);
    gap_pairs.visit_apart([&](Index p, Index q) { apart.join(p, q); });
    gap_pairs.visit_border([&](Index p, Index q) { rounding.end_before_gap(p, q); });
  }
  for (const auto& [i, j] : apart.pairs().pairs()) {
    if (!locality.are_one_volume(i, j)) locality.apart.insert(i, j);
  }
  for (const auto& [i, j] : near_gaps.pairs().pairs()) {
    if (!locality.are_one_volume(i, j) && !locality.apart.contains(i, j)) locality.parting.insert(i, j);
  }
  if (blend > kMostBlend)
    visit_unrelated(chain, {&touching, &parting}, locality, [&](Index p, Index q) { rounding.end_before_gap(p, q); });
  locality.rounding = rounding.take();
  part_unrelated_segments(centerline, chain, wide, locality);
  return locality;
}

}  // namespace vmesh
