#include "surface/pieces/division.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/surface/error_bound.h"

#include "surface/remesh/sweep_state.h"
#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

// Rings between two seams: a piece of some 600 vertices at 6 around; safe 67 to 134.
constexpr std::size_t kLongest = 96;
// Rings of a tube that stay with a junction where the tube is longer than kShort, so that remaking the junction does
// not remake whole vessels.
constexpr std::size_t kBeside = 12, kShort = 40;  // kBeside: safe 8 to 17; kShort: safe 28 to 56
// Rings before and after the middle that may become the seam instead of it; safe 2 to 4.
constexpr std::size_t kWindow = 3;

// Two rings and the faces between them.
struct Band {
  std::vector<Vec3> points;
  std::vector<Index> cones;
  std::vector<Triangle> faces;
  ElongatedMetric metric;

  Band(const Ring& ring, const Ring& next) : metric(0.5 * (ring.metric() + next.metric())) {
    for (const Ring* r : {&ring, &next}) {
      for (const RingPoint& p : r->points) {
        points.push_back(p.position);
        cones.push_back(p.cone);
      }
    }
    const std::size_t count = ring.points.size();
    faces = stitch(std::span(points).first(count), std::span(points).subspan(count));
  }
};

// Chooses seams along a branch.
class SeamSearch {
 public:
  SeamSearch(const VesselAxes& axes, const GenerateOptions& options, Index branch, std::span<const Ring> rings)
      : field_(axes.field()),
        options_(options),
        proof_(axes.field()),
        axis_(axes.axes()[branch]),
        branch_(branch),
        rings_(rings) {}

  std::vector<RingPlace> run() {
    const std::span<const Ring> rings = rings_;
    const BranchAxis& axis = axis_;
    for (std::size_t k = 0; k < rings.size();) {
      if (!rings[k].free) {
        ++k;
        continue;
      }
      const std::size_t first = k;
      while (k < rings.size() && rings[k].free) ++k;
      const bool free_begin = first == 0 && (axis.starts_at_tip() || axis.periodic());
      const bool free_end = k == rings.size() && (axis.ends_at_tip() || axis.periodic());
      divide({first, k}, !free_begin, !free_end);
    }
    return std::move(seams_);
  }

 private:
  struct Run {
    std::size_t first, end;
  };

  // Divides a run of rings into equal stretches no longer than kLongest, at least two between two junctions; in a long
  // run, the rings that stay with the junctions are not divided.
  void divide(const Run& run, bool from_junction, bool to_junction) {
    const std::size_t count = run.end - run.first;
    std::size_t begin = run.first, last = run.end - 1;
    if (count > kShort) {
      if (from_junction) add_near(run, begin += kBeside);
      if (to_junction) last -= kBeside;
    }
    const std::size_t least = count <= kShort && from_junction && to_junction ? 2 : 1;
    const std::size_t parts = std::max(least, (last + 1 - begin + kLongest - 1) / kLongest);
    for (std::size_t i = 1; i < parts; ++i) add_near(run, begin + i * (last - begin) / parts);
    if (last + 1 < run.end) add_near(run, last);
  }

  void add_near(const Run& run, std::size_t middle) {
    const std::size_t low = std::max(run.first + 1, middle - std::min(middle, kWindow));
    const std::size_t high = std::min(run.end - 1, middle + kWindow + 1);
    add_best(middle, low, high);
  }

  // Adds the even ring of [low, high) nearest to the middle, if there is one.
  void add_best(std::size_t middle, std::size_t low, std::size_t high) {
    std::vector<std::pair<std::size_t, std::size_t>> order;
    for (std::size_t k = low; k < high; ++k) order.emplace_back(k > middle ? k - middle : middle - k, k);
    std::sort(order.begin(), order.end());
    for (const auto& [away, k] : order) {
      if (!is_even(k)) continue;
      seams_.push_back({branch_, static_cast<Index>(k)});
      return;
    }
  }

  bool is_even(std::size_t k) const {
    return is_even(Band(rings_[k - 1], rings_[k])) && is_even(Band(rings_[k], rings_[k + 1])) &&
           !near_others(rings_[k]);
  }

  // Whether the faces are already as good as optimisation would make them, and as close to the boundary as requested.
  bool is_even(const Band& band) const {
    return std::all_of(band.faces.begin(), band.faces.end(), [&](const Triangle& f) {
      const std::array<Vec3, 3> p = {band.points[f[0]], band.points[f[1]], band.points[f[2]]};
      if (SweepState::elongated_energy(p[0], p[1], p[2], band.metric) >= kSeamEnergy) return false;
      const FieldSample center = field_.sample((p[0] + p[1] + p[2]) / 3, band.cones[f[0]]);
      const double radius = field_.relations().radius_at(center.cone, center.t);
      const double before_lift = std::abs(center.distance) + (balanced_ring_radius(options_.around) - 1) * radius;
      if (before_lift > options_.max_center_distance * radius) return false;
      return !options_.max_error.is_set() || is_proven(band, f, radius);
    });
  }

  bool is_proven(const Band& band, const Triangle& f, double radius) const {
    ErrorProof::Face face;
    for (int i = 0; i < 3; ++i) {
      const FieldSample s = field_.sample(band.points[f[i]], band.cones[f[i]]);
      face[i] = {band.points[f[i]], s.gradient.normalized(), kSeamLimit * options_.max_error.at(radius), s.cone};
    }
    const ErrorProof::Shares shares = proof_.shares(face);
    return shares.inner > 0 && shares.outer > 0;
  }

  // Near another wall it is not known yet how far vertices may be lifted.
  bool near_others(const Ring& ring) const {
    const double reach = kClear * ring.radius;
    return std::any_of(ring.points.begin(), ring.points.end(), [&](const RingPoint& p) {
      return field_.distance_to_others(p.position, p.cone, reach) < reach;
    });
  }

  // Measured on sixteen trees (ten portal veins, tree1560 among them): compared with 1.05, mean skewness grows by 0.3
  // %, the maximum stays the same, and the largest piece of tree1560 has half as many nodes.
  static constexpr double kSeamEnergy = 1.5;  // safe 1.05 to 1.5
  // Radii: more than the highest lift, a third of a radius, plus room for the edges; safe 0.35 to 0.7.
  static constexpr double kClear = 0.5;

  // Of the error limit: neighbouring faces with lower shells use up some of it; idle 0.56 to 1.1.
  static constexpr double kSeamLimit = 0.8;

  const VesselField& field_;
  const GenerateOptions& options_;
  ErrorProof proof_;
  const BranchAxis& axis_;
  Index branch_;
  const std::span<const Ring> rings_;
  std::vector<RingPlace> seams_;
};

// The stretches of a branch between its seams.
void add_stretches(const RingCounts& rings, Index branch, std::span<const RingPlace> seams,
                   std::vector<Stretch>& stretches) {
  const auto count = rings.along(branch);
  const bool periodic = rings.is_loop(branch);
  if (seams.empty()) {
    stretches.push_back({branch, 0, count});
    return;
  }
  if (!periodic) stretches.push_back({branch, 0, seams.front().ring + 1, false, true});
  for (std::size_t s = 0; s + 1 < seams.size(); ++s)
    stretches.push_back({branch, seams[s].ring, seams[s + 1].ring - seams[s].ring + 1, true, true});
  const Index from = seams.back().ring;
  if (periodic) {
    stretches.push_back({branch, from, count - from + seams.front().ring + 1, true, true});
  } else {
    stretches.push_back({branch, from, count - from, true, false});
  }
}

std::vector<Stretch> stretches_between(const RingCounts& rings, const std::vector<RingPlace>& seams) {
  std::vector<Stretch> stretches;
  auto first = seams.begin();
  for (Index b = 0; b < rings.branch_count(); ++b) {
    const auto last = std::find_if(first, seams.end(), [&](const RingPlace& seam) { return seam.branch != b; });
    add_stretches(rings, b, std::span(seams).subspan(first - seams.begin(), last - first), stretches);
    first = last;
  }
  return stretches;
}

// Collects connected stretches and nodes into plans.
class PlanMaker {
 public:
  PlanMaker(const RingCounts& rings, std::vector<Stretch> stretches)
      : rings_(rings),
        stretches_(std::move(stretches)),
        node_count_(static_cast<Index>(rings.centerline().nodes().size())),
        parts_(stretches_.size() + node_count_) {
    for (Index i = 0; i < stretches_.size(); ++i) {
      const RingCounts::Ends& ends = rings.ends(stretches_[i].branch);
      if (!stretches_[i].seam_at_first) parts_.join(i, part_of(ends.first));
      if (!stretches_[i].seam_at_last) parts_.join(i, part_of(ends.last));
    }
  }

  void join(const Anchor& a, const Anchor& b) { parts_.join(part_of(a), part_of(b)); }

  std::vector<PiecePlan> run() {
    std::vector<PiecePlan> plans;
    std::vector<Index> number(stretches_.size() + node_count_, kNone);
    const auto plan_of = [&](Index part) -> PiecePlan& {
      Index& n = number[parts_.find(part)];
      if (n == kNone) {
        n = static_cast<Index>(plans.size());
        plans.emplace_back();
      }
      return plans[n];
    };
    for (Index i = 0; i < stretches_.size(); ++i) plan_of(i).stretches.push_back(stretches_[i]);
    for (Index n = 0; n < node_count_; ++n) {
      if (rings_.centerline().degree(n) != 2) plan_of(part_of(n)).nodes.push_back(n);
    }
    return plans;
  }

 private:
  Index part_of(Index node) const { return static_cast<Index>(stretches_.size() + node); }

  Index part_of(const Anchor& anchor) const {
    if (anchor.node != kNone) return part_of(anchor.node);
    const Index count = rings_.along(anchor.ring.branch);
    const auto holds = [&](const Stretch& stretch) {
      return stretch.branch == anchor.ring.branch &&
             (anchor.ring.ring + count - stretch.first) % count + (stretch.seam_at_last ? 1 : 0) < stretch.count;
    };
    return static_cast<Index>(std::find_if(stretches_.begin(), stretches_.end(), holds) - stretches_.begin());
  }

  const RingCounts& rings_;
  std::vector<Stretch> stretches_;
  Index node_count_;
  DisjointSets parts_;
};

// Seams with the same piece on both sides, where it would touch itself. Ascending.
std::vector<RingPlace> within_one_piece(const RingCounts& rings, const std::vector<PiecePlan>& plans) {
  std::vector<std::pair<RingPlace, Index>> sides;
  for (Index p = 0; p < plans.size(); ++p) {
    for (const RingPlace& seam : seams_of(rings, plans[p])) sides.emplace_back(seam, p);
  }
  std::sort(sides.begin(), sides.end());
  std::vector<RingPlace> within;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i] == sides[i - 1]) within.push_back(sides[i].first);
  }
  return within;
}

std::vector<RingPlace> without(const std::vector<RingPlace>& seams, const std::vector<RingPlace>& dissolved) {
  std::vector<RingPlace> kept;
  std::set_difference(seams.begin(), seams.end(), dissolved.begin(), dissolved.end(), std::back_inserter(kept));
  return kept;
}

Division divide_at(const RingCounts& rings, std::vector<RingPlace> seams,
                   std::vector<std::pair<Anchor, Anchor>> joined) {
  for (;;) {
    PlanMaker maker(rings, stretches_between(rings, seams));
    for (const auto& [a, b] : joined) maker.join(a, b);
    std::vector<PiecePlan> plans = maker.run();
    const std::vector<RingPlace> within = within_one_piece(rings, plans);
    if (within.empty()) return {std::move(seams), std::move(plans), std::move(joined)};
    seams = without(seams, within);
  }
}

}  // namespace

std::vector<RingPlace> seams_of(const RingCounts& rings, const PiecePlan& plan) {
  std::vector<RingPlace> seams;
  for (const Stretch& s : plan.stretches) {
    const Index count = rings.along(s.branch);
    if (s.seam_at_first) seams.push_back({s.branch, s.first});
    if (s.seam_at_last) seams.push_back({s.branch, (s.first + s.count - 1) % count});
  }
  return seams;
}

Anchor anchor_of(const PiecePlan& plan) {
  if (plan.stretches.empty()) return {{}, plan.nodes.front()};
  return {{plan.stretches.front().branch, plan.stretches.front().first}, kNone};
}

RingCounts::RingCounts(const VesselRings& tubes) : centerline_(tubes.centerline()) {
  for (Index b = 0; b < tubes.axes().size(); ++b) {
    const Branch& branch = tubes.branches()[b];
    ends_.push_back({branch.nodes.front(), branch.nodes.back()});
    counts_.push_back(tubes.ring_count(b));
  }
}

std::vector<RingPlace> find_seams(const VesselAxes& axes, const GenerateOptions& options, Index branch,
                                  std::span<const Ring> rings) {
  return SeamSearch(axes, options, branch, rings).run();
}

Division divide(const RingCounts& rings, std::vector<RingPlace> seams) {
  return divide_at(rings, std::move(seams), {});
}

Division divide(const VesselRings& tubes, const GenerateOptions& options) {
  std::vector<std::vector<RingPlace>> found(tubes.axes().size());
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
    const auto b = static_cast<Index>(i);
    found[i] = find_seams(tubes, options, b, tubes.rings(b));
  });
  std::vector<RingPlace> seams;
  for (const auto& of_branch : found) seams.insert(seams.end(), of_branch.begin(), of_branch.end());
  return divide(RingCounts(tubes), std::move(seams));
}

Division regrouped(const RingCounts& rings, const Division& division, const std::vector<RingPlace>& dissolved,
                   const std::vector<std::pair<Anchor, Anchor>>& joined) {
  std::vector<std::pair<Anchor, Anchor>> all = division.joined;
  all.insert(all.end(), joined.begin(), joined.end());
  return divide_at(rings, without(division.seams, dissolved), std::move(all));
}

}  // namespace vmesh
