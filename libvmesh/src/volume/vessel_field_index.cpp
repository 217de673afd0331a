// How a VesselField finds the cones that matter at a point: along the graph, and in space.
#include <cmath>
#include <limits>
#include <numeric>

#include "vmesh/volume/vessel_field.h"

#include "volume/local_pairs.h"

namespace vmesh {
namespace {

// Relative to coordinates: covers the rounding in a distance and in a box.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

void VesselField::find_local_cones() {
  const PairSet set = local_pairs(*centerline_, kOneVolume);

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
