// How a VesselField finds the cones that matter at a point, along the graph and in space.
#include <cmath>
#include <limits>

#include "vmesh/core/ascending.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {
namespace {

// Relative to coordinates: covers the rounding in a distance and in a box.
constexpr double kIndexRounding = 16 * std::numeric_limits<double>::epsilon();
// Length of an interval of a cone, relative to the distance from its axis that counts as near; idle 1.4 to 2.8.
constexpr double kLongPiece = 2;
constexpr int kMostPieces = 16;         // of a cone; idle 11 to 22
constexpr std::size_t kFewCones = 100;  // up to here a linear scan is as fast; measured on stars: 60 to 512 are near

// Keeps those of `cones` that are in the ascending list.
void keep_listed(std::span<const Index> list, std::vector<Index>& cones) {
  sort_unique(cones);
  std::erase_if(cones, [&](Index c) { return !std::binary_search(list.begin(), list.end(), c); });
}

}  // namespace

bool VesselField::are_blended(Index i, Index j) const {
  if (!cones_[i].is_apart || !cones_[j].is_apart) return true;
  const std::pair<Index, Index> pair = std::minmax(i, j);
  return !std::binary_search(relations_.apart().begin(), relations_.apart().end(), pair);
}

// The box of an interval of a cone holds all points at which it may be blended: those closer to it than the widest
// blend. Cones that are long for their width are divided into intervals; oblique to the coordinate axes, their boxes
// would be as wide as long.
void VesselField::build_tree() {
  std::vector<Vec3> low, high;
  for (Index c = 0; c < cones_.size(); ++c) {
    const Cone& cone = cones_[c];
    const double margin = 2 * blend_ * max_radius(c);
    const double pieces = std::ceil(cone.axis.norm() / (kLongPiece * (max_radius(c) + margin)));
    const int count = static_cast<int>(std::clamp(pieces, 1.0, double{kMostPieces}));
    for (int k = 0; k < count; ++k) {
      const double t0 = static_cast<double>(k) / count, t1 = static_cast<double>(k + 1) / count;
      const Vec3 begin = cone.origin + t0 * cone.axis, end = cone.origin + t1 * cone.axis;
      const double r0 = cone.radius_at(t0), r1 = cone.radius_at(t1);
      low.push_back((begin.array() - r0).min(end.array() - r1));
      high.push_back((begin.array() + r0).max(end.array() + r1));
      const double size = low.back().cwiseAbs().cwiseMax(high.back().cwiseAbs()).maxCoeff();
      low.back().array() -= margin + kIndexRounding * size;
      high.back().array() += margin + kIndexRounding * size;
      cone_of_item_.push_back(c);
    }
  }
  tree_ = BoxTree(low, high);
}

void VesselField::local_cones_near(const Vec3& p, Index cone, double limit, std::vector<Index>& near) const {
  const std::span<const Index> local = relations_.local_cones(cone);
  near.clear();
  if (local.size() <= kFewCones) {
    near.assign(local.begin(), local.end());
    return;
  }
  const double most = limit + kIndexRounding * p.norm();
  visit_near(p, most, [&](Index c) { near.push_back(c); });
  keep_listed(local, near);
}

// Same as blended(p, local_cones(hint), hint).
FieldSample VesselField::blended_local(const Vec3& p, Index hint) const {
  const std::span<const Index> local = relations_.local_cones(hint);
  if (local.size() <= kFewCones) return blended(p, local, hint);
  thread_local std::vector<Index> near;
  near.clear();
  const double rounding = kIndexRounding * p.norm();
  double limit = cones_[hint].distance_to(p).value + rounding;
  visit_near(p, limit, [&](Index c) {
    const double value = cones_[c].distance_to(p).value;
    if (value > limit + 2 * blend_ * max_radius(c) || !std::binary_search(local.begin(), local.end(), c)) return;
    near.push_back(c);
    limit = std::min(limit, value + rounding);
  });
  sort_unique(near);
  return blended(p, near, hint);
}

}  // namespace vmesh
