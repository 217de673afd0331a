// How a VesselField finds the cones that matter at a point: along the graph, and in space.
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <unordered_set>

#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

// Overlap that keeps siblings one union: measured in sums of radii (ALGORITHM: flooding of the locality).
constexpr double kOverlapFactor = 1.3;
// Relative to coordinates: covers the rounding in a distance and in a box.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

double segment_distance(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v) {
  const Vec3 w = p - q;
  const double a = u.dot(u), b = u.dot(v), c = v.dot(v), d = u.dot(w), e = v.dot(w);
  const double det = a * c - b * b;
  double s = det > 1e-14 * a * c ? std::clamp((b * e - c * d) / det, 0.0, 1.0) : 0.0;
  double t = c > 0 ? std::clamp((b * s + e) / c, 0.0, 1.0) : 0.0;
  s = a > 0 ? std::clamp((b * t - d) / a, 0.0, 1.0) : 0.0;
  t = c > 0 ? std::clamp((b * s + e) / c, 0.0, 1.0) : 0.0;
  return (w + s * u - t * v).norm();
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

bool VesselField::overlap(Index i, Index j) const {
  const Cone &x = cones_[i], &y = cones_[j];
  return segment_distance(x.origin, x.axis, y.origin, y.axis) < kOverlapFactor * (max_radius(i) + max_radius(j));
}

void VesselField::find_local_cones() {
  const auto segment_count = static_cast<Index>(centerline_->segments().size());
  PairSet set;
  for (Index i = 0; i < segment_count; ++i) {
    for (const Index node : {cones_[i].a, cones_[i].b}) {
      for (const Index j : centerline_->incident_segments(node)) {
        if (j != i) set.insert(i, j);
      }
    }
  }
  const auto flood = [&](Index i, Index j) {  // neighbours of i that overlap j
    for (const Index node : {cones_[i].a, cones_[i].b}) {
      for (const Index k : centerline_->incident_segments(node)) {
        if (k != i && k != j && overlap(k, j)) set.insert(k, j);
      }
    }
  };
  for (std::size_t n = 0; n < set.pairs().size(); ++n) {
    const auto [i, j] = set.pairs()[n];
    if (!overlap(i, j)) continue;
    flood(i, j);
    flood(j, i);
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
