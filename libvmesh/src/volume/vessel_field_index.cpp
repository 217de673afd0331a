// How a VesselField finds the cones that matter at a point: along the graph, and in space.
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

constexpr double kContact = 1.25;  // sums of radii within which two spheres of the volume touch, or blend
constexpr double kSampling = 0.5;  // mean radii between two spheres that stand for a cone
constexpr int kMaxSamples = 200;   // per cone
// Relative to coordinates: covers the rounding in a distance and in a box.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

// Spheres along all segments, every one next to those before and after it.
struct SphereChain {
  std::vector<Vec3> centers;
  std::vector<double> radii;
  std::vector<std::vector<Index>> next;   // neighbours along the centerline
  std::vector<std::vector<Index>> cones;  // of which a sphere is part: several at a node
};

SphereChain make_chain(const Centerline& centerline) {
  SphereChain chain;
  const auto add = [&](const Vec3& center, double radius) {
    chain.centers.push_back(center);
    chain.radii.push_back(radius);
    chain.next.emplace_back();
    chain.cones.emplace_back();
    return static_cast<Index>(chain.centers.size() - 1);
  };
  const auto link = [&](Index p, Index q, Index cone) {
    chain.next[p].push_back(q);
    chain.next[q].push_back(p);
    for (const Index sphere : {p, q}) {
      if (chain.cones[sphere].empty() || chain.cones[sphere].back() != cone) chain.cones[sphere].push_back(cone);
    }
  };
  for (const auto& node : centerline.nodes()) add(node.position, node.radius);
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const double steps = std::ceil(centerline.length(s) / (kSampling * centerline.radius_at(s, 0.5)));
    const int count = static_cast<int>(std::clamp(steps, 1.0, double{kMaxSamples}));
    Index last = centerline.segment(s).a;
    for (int k = 1; k < count; ++k) {
      const double t = static_cast<double>(k) / count;
      const Index sphere = add(centerline.point_at(s, t), centerline.radius_at(s, t));
      link(last, sphere, s);
      last = sphere;
    }
    link(last, centerline.segment(s).b, s);
  }
  return chain;
}

// A growing symmetric relation between cones.
class PairSet {
 public:
  bool insert(Index i, Index j) {
    const auto [low, high] = std::minmax(i, j);
    if (!known_.insert(std::uint64_t{low} << 32 | high).second) return false;
    pairs_.emplace_back(low, high);
    return true;
  }
  const std::vector<std::pair<Index, Index>>& pairs() const { return pairs_; }

 private:
  std::unordered_set<std::uint64_t> known_;
  std::vector<std::pair<Index, Index>> pairs_;
};

}  // namespace

// Two cones are local to each other where a pair of spheres, one on each, can be reached from a pair of one and the
// same by moving either along the centerline without losing touch.
void VesselField::find_local_cones() {
  const SphereChain chain = make_chain(*centerline_);
  PairSet touching, set;
  const auto touch = [&](Index p, Index q) {
    const double reach = kContact * (chain.radii[p] + chain.radii[q]);
    if ((chain.centers[p] - chain.centers[q]).squaredNorm() < reach * reach && p != q) touching.insert(p, q);
  };
  for (Index p = 0; p < chain.centers.size(); ++p) {
    for (const Index i : chain.cones[p]) {
      for (const Index j : chain.cones[p]) {
        if (i != j) set.insert(i, j);
      }
    }
    for (const Index q : chain.next[p]) touch(p, q);
    for (std::size_t n = 0; n < chain.next[p].size(); ++n) {
      for (std::size_t m = 0; m < n; ++m) touch(chain.next[p][n], chain.next[p][m]);
    }
  }
  for (std::size_t n = 0; n < touching.pairs().size(); ++n) {
    const auto [p, q] = touching.pairs()[n];
    for (const Index i : chain.cones[p]) {
      for (const Index j : chain.cones[q]) {
        if (i != j) set.insert(i, j);
      }
    }
    for (const Index next : chain.next[p]) touch(next, q);
    for (const Index next : chain.next[q]) touch(p, next);
  }

  local_offsets_.assign(cones_.size() + 1, 0);
  for (std::size_t c = 0; c < cones_.size(); ++c) ++local_offsets_[c + 1];
  for (const auto& [i, j] : set.pairs()) {
    ++local_offsets_[i + 1];
    ++local_offsets_[j + 1];
  }
  std::partial_sum(local_offsets_.begin(), local_offsets_.end(), local_offsets_.begin());
  local_.resize(local_offsets_.back());
  std::vector<Index> next(local_offsets_.begin(), local_offsets_.end() - 1);
  for (Index c = 0; c < cones_.size(); ++c) local_[next[c]++] = c;
  for (const auto& [i, j] : set.pairs()) {
    local_[next[i]++] = j;
    local_[next[j]++] = i;
  }
  for (Index c = 0; c < cones_.size(); ++c) {
    std::sort(local_.begin() + local_offsets_[c], local_.begin() + local_offsets_[c + 1]);
  }
}

// The box of a cone holds all points at which it may be blended in: those closer to it than the widest blend.
void VesselField::build_tree() {
  std::vector<Vec3> low(cones_.size()), high(cones_.size());
  for (Index c = 0; c < cones_.size(); ++c) {
    const Cone& cone = cones_[c];
    const Vec3 end = cone.origin + cone.axis;
    low[c] = (cone.origin.array() - cone.r0).min(end.array() - cone.r1);
    high[c] = (cone.origin.array() + cone.r0).max(end.array() + cone.r1);
    const double size = low[c].cwiseAbs().cwiseMax(high[c].cwiseAbs()).maxCoeff();
    const double margin = 2 * blend_ * max_radius(c) + kRounding * size;
    low[c].array() -= margin;
    high[c].array() += margin;
  }
  tree_ = BoxTree(low, high);
}

}  // namespace vmesh
