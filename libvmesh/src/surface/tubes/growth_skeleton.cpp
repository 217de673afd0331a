#include "surface/tubes/growth_skeleton.h"

#include <map>
#include <numeric>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh {
namespace {

constexpr double kShortHandle = 6;  // rings; measured on random graphs with loops; safe 4 to 8

std::vector<BranchPlace> places_of(const Centerline& centerline, const std::vector<Branch>& branches) {
  std::vector<BranchPlace> places(centerline.segments().size());
  for (Index b = 0; b < branches.size(); ++b) {
    const auto& segments = branches[b].segments;
    for (Index i = 0; i < segments.size(); ++i) places[segments[i]] = {b, i};
  }
  return places;
}

std::vector<BranchAxis> axes_of(const Centerline& centerline, const std::vector<Branch>& branches) {
  std::vector<BranchAxis> axes;
  for (const Branch& branch : branches) axes.emplace_back(centerline, branch);
  return axes;
}

class SkeletonMaker {
 public:
  SkeletonMaker(const VesselRings& all_rings, const PiecePlan& plan, const std::vector<RingPlace>& covered)
      : all_rings_(all_rings), plan_(plan) {
    for (const Stretch& stretch : plan.stretches) rings_.push_back(rings_of(stretch, covered));
  }

  GrowthSkeleton run() {
    do {
      divide_all();
    } while (dissolve_handles());
    skeleton_.rings = std::move(rings_);
    skeleton_.seam_points = std::move(seam_points_);
    return std::move(skeleton_);
  }

 private:
  const BranchAxis& axis_of(const Stretch& stretch) const { return all_rings_.axes()[stretch.branch]; }

  bool is_loop(const Stretch& stretch) const {
    return axis_of(stretch).periodic() && !stretch.seam_at_first && !stretch.seam_at_last;
  }

  std::vector<Ring> rings_of(const Stretch& stretch, const std::vector<RingPlace>& covered) {
    const std::span<const Ring> all = all_rings_.rings(stretch.branch);
    std::vector<Ring> rings;
    bool changed = false;
    for (Index k = 0; k < stretch.count; ++k) {
      const auto number = static_cast<Index>((stretch.first + k) % all.size());
      rings.push_back(all[number]);
      const bool is_seam = (k == 0 && stretch.seam_at_first) || (k + 1 == stretch.count && stretch.seam_at_last);
      if (is_seam) {
        seam_points_.push_back(all_rings_.layer().lifted(stretch.branch, rings.back()));
        rings.back().points = seam_points_.back();
      }
      if (is_seam || !rings.back().free) continue;
      if (!std::binary_search(covered.begin(), covered.end(), RingPlace{stretch.branch, number})) continue;
      rings.back().free = false;
      changed = true;
    }
    if (changed) {
      all_rings_.layer().clear_ends(stretch.branch, rings, is_loop(stretch));
      if (stretch.seam_at_first) rings.front().free = true;
      if (stretch.seam_at_last) rings.back().free = true;
    }
    return rings;
  }

  void divide_all() {
    skeleton_ = {};
    bare_.clear();
    capped_.clear();
    for (std::size_t i = 0; i < plan_.stretches.size(); ++i) divide(plan_.stretches[i], rings_[i]);
    collect_junctions();
  }

  // A short tube with both ends at the same junction is given to the junction, whose vessels would overlap at its ends.
  bool dissolve_handles() {
    bool dissolved = false;
    std::vector<Index> first(skeleton_.tubes.size(), kNone);
    for (Index j = 0; j < skeleton_.junctions.size(); ++j) {
      for (const TubeEnd& end : docks_of(skeleton_.junctions[j])) {
        if (first[end.tube] == kNone) {
          first[end.tube] = j;
        } else if (first[end.tube] == j && even_rings(skeleton_.tubes[end.tube]) <= kShortHandle) {
          cover(skeleton_.tubes[end.tube]);
          dissolved = true;
        }
      }
    }
    return dissolved;
  }

  void cover(const Tube& tube) {
    for (std::vector<Ring>& rings : rings_) {
      const auto first = tube.rings.data() - rings.data();
      if (first < 0 || static_cast<std::size_t>(first) >= rings.size()) continue;
      for (std::size_t k = 0; k < tube.rings.size(); ++k) rings[static_cast<std::size_t>(first) + k].free = false;
    }
  }

  // The run of free rings that starts at number `k`; `k` becomes the number of the first ring after it.
  static std::span<const Ring> free_run(const std::vector<Ring>& rings, std::size_t& k) {
    const std::size_t first = k;
    while (k < rings.size() && rings[k].free) ++k;
    return {rings.data() + first, k - first};
  }

  // Runs of free rings become tubes; the stretches between them are bare.
  void divide(const Stretch& stretch, std::vector<Ring>& rings) {
    if (is_loop(stretch)) {
      divide_loop(stretch, rings);
      return;
    }
    const BranchAxis& axis = axis_of(stretch);
    const Index b = stretch.branch;
    const bool from_begin = !stretch.seam_at_first, to_end = !stretch.seam_at_last;
    BareStretch bare{b, 0, 0, {}};
    for (std::size_t k = 0; k < rings.size();) {
      if (!rings[k].free) {
        ++k;
        continue;
      }
      Tube tube;
      tube.branch = b;
      tube.starts_at_tip = from_begin && k == 0 && axis.starts_at_tip();
      tube.starts_at_seam = k == 0 && stretch.seam_at_first;
      tube.rings = free_run(rings, k);
      tube.ends_at_tip = to_end && k == rings.size() && axis.ends_at_tip();
      tube.ends_at_seam = k == rings.size() && stretch.seam_at_last;
      const auto number = static_cast<Index>(skeleton_.tubes.size());
      if (tube.starts_at_tip) capped_[axis.branch().nodes.front()] = 1;
      if (tube.starts_at_junction()) {
        bare.end = tube.rings.front().place;
        if (axis.periodic() && bare.end <= bare.begin) bare.end += axis.length();
        bare.docks[1] = {number, false};
        bare_.push_back(bare);
      }
      if (tube.ends_at_tip) capped_[axis.branch().nodes.back()] = 1;
      bare = {b, tube.rings.back().place, axis.length(), {}};
      bare.docks[0] = {number, true};
      skeleton_.tubes.push_back(tube);
    }
    const bool closed =
        !skeleton_.tubes.empty() && skeleton_.tubes.back().branch == b && to_end && skeleton_.tubes.back().ends_at_tip;
    if (to_end && !closed) {
      bare.end = axis.length();
      bare_.push_back(bare);
    }
  }

  void divide_loop(const Stretch& stretch, std::vector<Ring>& rings) {
    const BranchAxis& axis = axis_of(stretch);
    const Index b = stretch.branch;
    const auto covered = std::find_if(rings.begin(), rings.end(), [](const Ring& r) { return !r.free; });
    if (covered == rings.end()) {
      Tube tube;
      tube.branch = b;
      tube.rings = rings;
      tube.periodic = true;
      skeleton_.tubes.push_back(tube);
      return;
    }
    std::rotate(rings.begin(), covered, rings.end());  // from a covered ring on
    const std::size_t first_tube = skeleton_.tubes.size();
    for (std::size_t k = 0; k < rings.size();) {
      if (!rings[k].free) {
        ++k;
        continue;
      }
      Tube tube;
      tube.branch = b;
      tube.rings = free_run(rings, k);
      skeleton_.tubes.push_back(tube);
    }
    const std::size_t count = skeleton_.tubes.size() - first_tube;
    if (count == 0) bare_.push_back({b, 0, axis.length(), {}});
    for (std::size_t i = 0; i < count; ++i) {
      const auto from = static_cast<Index>(first_tube + i), to = static_cast<Index>(first_tube + (i + 1) % count);
      BareStretch bare{b, skeleton_.tubes[from].rings.back().place, skeleton_.tubes[to].rings.front().place, {}};
      if (bare.end <= bare.begin) bare.end += axis.length();
      bare.docks = {TubeEnd{from, true}, TubeEnd{to, false}};
      bare_.push_back(bare);
    }
  }

  // Bare stretches and nodes that touch form one junction.
  void collect_junctions() {
    const auto node_count = static_cast<Index>(plan_.nodes.size());
    DisjointSets parts(node_count + bare_.size());
    std::vector<char> taken(node_count, 0);
    for (Index i = 0; i < node_count; ++i) taken[i] = !capped_.contains(plan_.nodes[i]);
    const auto join = [&](Index node, Index part) {
      const auto i =
          static_cast<Index>(std::lower_bound(plan_.nodes.begin(), plan_.nodes.end(), node) - plan_.nodes.begin());
      if (i == node_count || plan_.nodes[i] != node) return;  // where a loop without a branching node closes
      taken[i] = 1;
      parts.join(i, part);
    };
    for (Index g = 0; g < bare_.size(); ++g) {
      const auto& nodes = all_rings_.axes()[bare_[g].branch].branch().nodes;
      if (bare_[g].docks[0].tube == kNone) join(nodes.front(), node_count + g);
      if (bare_[g].docks[1].tube == kNone) join(nodes.back(), node_count + g);
    }
    std::vector<Index> number(node_count + bare_.size(), kNone);
    const auto junction_of = [&](Index part) -> Junction& {
      Index& n = number[parts.find(part)];
      if (n == kNone) {
        n = static_cast<Index>(skeleton_.junctions.size());
        skeleton_.junctions.emplace_back();
      }
      return skeleton_.junctions[n];
    };
    for (Index i = 0; i < node_count; ++i) {
      if (taken[i]) junction_of(i).nodes.push_back(plan_.nodes[i]);
    }
    for (Index g = 0; g < bare_.size(); ++g) {
      Junction& junction = junction_of(node_count + g);
      const auto& nodes = all_rings_.axes()[bare_[g].branch].branch().nodes;
      // A loop that is a single bare stretch is attached to its own first node.
      if (junction.nodes.empty() && bare_[g].docks[0].tube == kNone) junction.nodes.push_back(nodes.front());
      junction.bare_stretches.push_back(bare_[g]);
    }
  }

  const VesselRings& all_rings_;
  const PiecePlan& plan_;
  std::vector<std::vector<Ring>> rings_;  // of the stretches
  std::vector<std::vector<RingPoint>> seam_points_;
  std::map<Index, char> capped_;  // tips that a tube's cap closes
  std::vector<BareStretch> bare_;
  GrowthSkeleton skeleton_;
};

}  // namespace

VesselAxes::VesselAxes(const VesselField& field, const RingOptions& rings)
    : VesselAxes(field, rings, find_branches(field.relations().centerline())) {}

VesselAxes::VesselAxes(const VesselField& field, const RingOptions& rings, std::vector<Branch> branches)
    : field_(field),
      branches_(std::move(branches)),
      axes_(axes_of(field.relations().centerline(), branches_)),
      places_(places_of(field.relations().centerline(), branches_)),
      layer_(field, axes_, places_, rings) {}

VesselRings::VesselRings(const VesselField& field, const RingOptions& rings)
    : VesselAxes(field, rings), rings_(axes().size()), elongated_(rings.elongation > 1) {
  lay_all();
}

VesselRings::VesselRings(const VesselField& field, const RingOptions& rings, std::vector<Branch> branches)
    : VesselAxes(field, rings, std::move(branches)), rings_(axes().size()), elongated_(rings.elongation > 1) {
  lay_all();
}

void VesselRings::lay_all() {
  counts_.resize(axes().size());
  profiles_.resize(axes().size());
  std::vector<Index> all(axes().size());
  std::iota(all.begin(), all.end(), Index{0});
  lay(all);
}

void VesselRings::lay(std::span<const Index> branches) {
  while (!branches.empty()) {
    const auto block = branches.first(std::min(branches.size(), RingBlocks::kBranches));
    std::vector<Rings> laid(block.size());
    tbb::parallel_for(std::size_t{0}, block.size(), [&](std::size_t i) { laid[i] = layer().lay(block[i]); });
    rings_.add(block, laid);
    for (std::size_t i = 0; i < block.size(); ++i) {
      counts_[block[i]] = static_cast<Index>(laid[i].rings.size());
      profiles_[block[i]] = std::move(laid[i].elongation);
    }
    branches = branches.subspan(block.size());
  }
}

void VesselRings::lay_again(const std::vector<Index>& branches) {
  std::vector<Index> released;
  for (const Index b : branches) {
    if (rings(b).empty()) released.push_back(b);
  }
  lay(released);
}

Elongation VesselRings::elongation_at(Index cone, double t) const {
  if (cone >= segment_count() || place_of(cone).branch == kNone) return {};
  const auto [branch, nth] = place_of(cone);
  const BranchAxis& axis = axes()[branch];
  const double place = axis.place_of(nth, t);
  const double times = profiles_[branch].at(axis.radii_of(place));
  if (times <= 1) return {};
  return {times, layer().direction_at(branch, place)};
}

Elongation VesselRings::longest_at(Index cone, double t, double times) const {
  if (cone >= segment_count() || place_of(cone).branch == kNone) return {};
  const auto [branch, nth] = place_of(cone);
  return {times, layer().direction_at(branch, axes()[branch].place_of(nth, t))};
}

double even_rings(const Tube& tube) {
  double count = 0;
  for (const Ring& ring : tube.rings) count += ring.elongation;
  return count;
}

PiecePlan whole_plan(const VesselRings& rings) {
  PiecePlan plan;
  const Centerline& centerline = rings.centerline();
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    if (centerline.degree(n) != 2) plan.nodes.push_back(n);
  }
  for (Index b = 0; b < rings.axes().size(); ++b) plan.stretches.push_back({b, 0, rings.ring_count(b)});
  return plan;
}

std::vector<TubeEnd> docks_of(const Junction& junction) {
  std::vector<TubeEnd> docks;
  for (const BareStretch& bare : junction.bare_stretches) {
    for (const TubeEnd& dock : bare.docks) {
      if (dock.tube != kNone) docks.push_back(dock);
    }
  }
  return docks;
}

std::size_t GrowthSkeleton::component_count() const {
  std::size_t count = junctions.size();
  DisjointSets parts(junctions.size());
  std::vector<Index> first(tubes.size(), kNone);
  for (Index j = 0; j < junctions.size(); ++j) {
    for (const TubeEnd& dock : docks_of(junctions[j])) {
      Index& other = first[dock.tube];
      if (other == kNone) {
        other = j;
      } else {
        count -= parts.join(other, j);
      }
    }
  }
  for (std::size_t t = 0; t < tubes.size(); ++t) count += first[t] == kNone;
  return count;
}

std::size_t GrowthSkeleton::cycle_rank() const {
  std::size_t joints = 0, loops = 0, lone = 0;
  for (const Tube& tube : tubes) {
    joints += tube.starts_at_junction() && tube.ends_at_junction();
    loops += tube.periodic;
    lone += !tube.starts_at_junction() && !tube.ends_at_junction();
  }
  return joints + loops + component_count() - lone - junctions.size();
}

GrowthSkeleton make_growth_skeleton(const VesselRings& rings, const PiecePlan& plan,
                                    const std::vector<RingPlace>& covered) {
  return SkeletonMaker(rings, plan, covered).run();
}

}  // namespace vmesh
