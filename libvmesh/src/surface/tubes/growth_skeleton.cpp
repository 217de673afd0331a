#include "surface/tubes/growth_skeleton.h"

#include <numeric>

#include <tbb/parallel_for.h>

namespace vmesh {
namespace {

constexpr std::size_t kShortHandle = 6;  // rings

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), Index{0}); }
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The lower number stays.
  void join(Index i, Index j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<Index> parent_;
};

class SkeletonMaker {
 public:
  SkeletonMaker(const VesselField& field, const std::vector<BranchAxis>& axes, int around)
      : centerline_(field.centerline()),
        axes_(axes),
        places_(places_of(field.centerline(), axes)),
        layer_(field, axes, places_, around) {}

  GrowthSkeleton run() {
    rings_.resize(axes_.size());
    tbb::parallel_for(std::size_t{0}, axes_.size(),
                      [&](std::size_t b) { rings_[b] = layer_.lay(static_cast<Index>(b)); });
    do {
      divide_all();
    } while (dissolve_handles());
    gather_rings();
    return std::move(skeleton_);
  }

 private:
  static std::vector<SegmentPlace> places_of(const Centerline& centerline, const std::vector<BranchAxis>& axes) {
    std::vector<SegmentPlace> places(centerline.segments().size());
    for (Index b = 0; b < axes.size(); ++b) {
      const auto& segments = axes[b].branch().segments;
      for (Index i = 0; i < segments.size(); ++i) places[segments[i]] = {b, i};
    }
    return places;
  }

  void divide_all() {
    skeleton_ = {};
    gaps_.clear();
    capped_.assign(centerline_.nodes().size(), 0);
    for (Index b = 0; b < axes_.size(); ++b) divide(b);
    collect_junctions();
  }

  // Copies the tubes' rings together. In a piece of memory for every branch, with what was freed between, they would
  // make all allocation after them slower, the more the larger the tree.
  void gather_rings() {
    Rings& all = skeleton_.rings;
    std::size_t rings = 0, points = 0;
    for (const Tube& tube : skeleton_.tubes) {
      rings += tube.rings.size();
      for (const Ring& ring : tube.rings) points += ring.points.size();
    }
    all.rings.reserve(rings);
    all.points.reserve(points);
    for (Tube& tube : skeleton_.tubes) {
      const Ring* first = all.rings.data() + all.rings.size();
      for (Ring ring : tube.rings) {
        const BoundaryPoint* place = all.points.data() + all.points.size();
        all.points.insert(all.points.end(), ring.points.begin(), ring.points.end());
        ring.points = {place, ring.points.size()};
        all.rings.push_back(ring);
      }
      tube.rings = {first, tube.rings.size()};
    }
  }

  // A short tube with both ends at one junction cannot be grown apart from it: the ends of the junction's vessels would
  // overlap there.
  bool dissolve_handles() {
    bool some = false;
    std::vector<Index> first(skeleton_.tubes.size(), kNone);
    for (Index j = 0; j < skeleton_.junctions.size(); ++j) {
      for (const TubeEnd& end : openings_of(skeleton_.junctions[j])) {
        if (first[end.tube] == kNone) {
          first[end.tube] = j;
        } else if (first[end.tube] == j && skeleton_.tubes[end.tube].rings.size() <= kShortHandle) {
          cover(skeleton_.tubes[end.tube]);
          some = true;
        }
      }
    }
    return some;
  }

  void cover(const Tube& tube) {
    std::vector<Ring>& rings = rings_[tube.branch].rings;
    const auto first = rings.begin() + (tube.rings.data() - rings.data());
    for (auto ring = first; ring != first + static_cast<std::ptrdiff_t>(tube.rings.size()); ++ring) ring->free = false;
  }

  // The free rings from number `k` on, up to the next that is not; `k` becomes the number of that one.
  static std::span<const Ring> free_run(const std::vector<Ring>& rings, std::size_t& k) {
    const std::size_t first = k;
    while (k < rings.size() && rings[k].free) ++k;
    return {rings.data() + first, k - first};
  }

  // Runs of free rings become tubes; what lies between them, gaps.
  void divide(Index b) {
    const BranchAxis& axis = axes_[b];
    if (axis.periodic()) {
      divide_loop(b);
      return;
    }
    const std::vector<Ring>& rings = rings_[b].rings;
    Gap gap{b, 0, 0, {}};
    for (std::size_t k = 0; k < rings.size();) {
      if (!rings[k].free) {
        ++k;
        continue;
      }
      Tube tube{b, {}, k == 0 && axis.starts_at_tip(), false, false};
      const bool first_is_tip = tube.starts_at_tip;
      tube.rings = free_run(rings, k);
      tube.ends_at_tip = k == rings.size() && axis.ends_at_tip();
      const auto number = static_cast<Index>(skeleton_.tubes.size());
      if (first_is_tip) {
        capped_[axis.branch().nodes.front()] = 1;
      } else {
        gap.end = tube.rings.front().place;
        gap.openings[1] = {number, false};
        gaps_.push_back(gap);
      }
      if (tube.ends_at_tip) capped_[axis.branch().nodes.back()] = 1;
      gap = {b, tube.rings.back().place, axis.length(), {}};
      gap.openings[0] = {number, true};
      skeleton_.tubes.push_back(std::move(tube));
    }
    if (skeleton_.tubes.empty() || skeleton_.tubes.back().branch != b || !skeleton_.tubes.back().ends_at_tip) {
      gap.end = axis.length();
      gaps_.push_back(gap);
    }
  }

  void divide_loop(Index b) {
    const BranchAxis& axis = axes_[b];
    std::vector<Ring>& rings = rings_[b].rings;
    const auto covered = std::find_if(rings.begin(), rings.end(), [](const Ring& r) { return !r.free; });
    if (covered == rings.end()) {
      skeleton_.tubes.push_back({b, rings, false, false, true});
      return;
    }
    std::rotate(rings.begin(), covered, rings.end());  // from a covered ring on
    const std::size_t first_tube = skeleton_.tubes.size();
    for (std::size_t k = 0; k < rings.size();) {
      if (!rings[k].free) {
        ++k;
        continue;
      }
      Tube tube{b, {}, false, false, false};
      tube.rings = free_run(rings, k);
      skeleton_.tubes.push_back(std::move(tube));
    }
    const std::size_t count = skeleton_.tubes.size() - first_tube;
    if (count == 0) gaps_.push_back({b, 0, axis.length(), {}});
    for (std::size_t i = 0; i < count; ++i) {
      const auto from = static_cast<Index>(first_tube + i), to = static_cast<Index>(first_tube + (i + 1) % count);
      Gap gap{b, skeleton_.tubes[from].rings.back().place, skeleton_.tubes[to].rings.front().place, {}};
      if (gap.end <= gap.begin) gap.end += axis.length();
      gap.openings = {TubeEnd{from, true}, TubeEnd{to, false}};
      gaps_.push_back(gap);
    }
  }

  // Gaps and nodes that touch form one junction.
  void collect_junctions() {
    const auto node_count = static_cast<Index>(centerline_.nodes().size());
    UnionFind pieces(node_count + gaps_.size());
    std::vector<char> taken(node_count, 0);
    for (Index n = 0; n < node_count; ++n) taken[n] = centerline_.degree(n) != 2 && !capped_[n];
    for (Index g = 0; g < gaps_.size(); ++g) {
      const auto& nodes = axes_[gaps_[g].branch].branch().nodes;
      if (gaps_[g].openings[0].tube == kNone) join(pieces, taken, nodes.front(), node_count + g);
      if (gaps_[g].openings[1].tube == kNone) join(pieces, taken, nodes.back(), node_count + g);
    }
    std::vector<Index> number(node_count + gaps_.size(), kNone);
    const auto junction_of = [&](Index piece) -> Junction& {
      Index& n = number[pieces.find(piece)];
      if (n == kNone) {
        n = static_cast<Index>(skeleton_.junctions.size());
        skeleton_.junctions.emplace_back();
      }
      return skeleton_.junctions[n];
    };
    for (Index n = 0; n < node_count; ++n) {
      if (taken[n]) junction_of(n).nodes.push_back(n);
    }
    for (Index g = 0; g < gaps_.size(); ++g) junction_of(node_count + g).gaps.push_back(gaps_[g]);
  }

  static void join(UnionFind& pieces, std::vector<char>& taken, Index node, Index piece) {
    taken[node] = 1;
    pieces.join(node, piece);
  }

  const Centerline& centerline_;
  const std::vector<BranchAxis>& axes_;
  std::vector<SegmentPlace> places_;
  RingLayer layer_;
  std::vector<Rings> rings_;  // of every branch
  std::vector<char> capped_;  // tips that a tube's cap closes
  std::vector<Gap> gaps_;
  GrowthSkeleton skeleton_;
};

}  // namespace

std::vector<TubeEnd> openings_of(const Junction& junction) {
  std::vector<TubeEnd> openings;
  for (const Gap& gap : junction.gaps) {
    for (const TubeEnd& opening : gap.openings) {
      if (opening.tube != kNone) openings.push_back(opening);
    }
  }
  return openings;
}

std::size_t GrowthSkeleton::component_count() const {
  std::size_t count = junctions.size();
  UnionFind pieces(junctions.size());
  std::vector<Index> first(tubes.size(), kNone);
  for (Index j = 0; j < junctions.size(); ++j) {
    for (const Gap& gap : junctions[j].gaps) {
      for (const TubeEnd& opening : gap.openings) {
        if (opening.tube == kNone) continue;
        Index& other = first[opening.tube];
        if (other == kNone) {
          other = j;
        } else if (pieces.find(other) != pieces.find(j)) {
          pieces.join(other, j);
          --count;
        }
      }
    }
  }
  for (std::size_t t = 0; t < tubes.size(); ++t) count += first[t] == kNone;
  return count;
}

std::size_t GrowthSkeleton::cycle_rank() const {
  std::size_t joints = 0, loops = 0, lone = 0;
  for (const Tube& tube : tubes) {
    joints += !tube.periodic && !tube.starts_at_tip && !tube.ends_at_tip;
    loops += tube.periodic;
    lone += tube.periodic || (tube.starts_at_tip && tube.ends_at_tip);
  }
  return joints + loops + component_count() - lone - junctions.size();
}

GrowthSkeleton make_growth_skeleton(const VesselField& field, const std::vector<BranchAxis>& axes, int around) {
  return SkeletonMaker(field, axes, around).run();
}

}  // namespace vmesh
