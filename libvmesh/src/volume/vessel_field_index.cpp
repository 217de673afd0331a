// How a VesselField finds the cones that matter at a point, along the graph and in space.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

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

// Of stretches of a hint's axis, in radii: their length, and the distance from its wall up to which all points are
// beside them; those beside the middle are so up to nearly twice that. In profiles of stars of 250 branches, queries
// take less than a third of what searches took. Not surveyed.
constexpr double kStretch = 1, kBeside = 0.25;
constexpr double kMostStretches = 256;  // of a hint
// By each thread; a prime, more than the stretches of the fan of a short star of 2,000 branches.
constexpr std::size_t kKeptVicinities = 131101;
constexpr std::size_t kSpread = 37;  // stretches of a hint that are kept beside each other

// Length of a list, relative to what is sought in it, up to which walking along it is faster than sorting and
// searching; deep within a node of many branches, nearly all are sought. Not surveyed.
constexpr std::size_t kWalked = 16;

// Keeps those of `cones` that are in the ascending list, ascending.
void keep_listed(std::span<const Index> list, std::vector<Index>& cones) {
  if (cones.size() * kWalked < list.size()) {
    sort_unique(cones);
    std::erase_if(cones, [&](Index c) { return !std::binary_search(list.begin(), list.end(), c); });
    return;
  }
  thread_local std::vector<Index> sought;
  thread_local std::vector<char> is_sought;  // of all cones; all 0 between calls
  sought.swap(cones);
  cones.clear();
  for (const Index c : sought) {
    if (c >= is_sought.size()) is_sought.resize(c + std::size_t{1}, 0);
    is_sought[c] = 1;
  }
  for (const Index c : list) {
    if (c < is_sought.size() && is_sought[c] != 0) cones.push_back(c);
  }
  for (const Index c : sought) is_sought[c] = 0;
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

// The cones that may be nearest or blended at points beside a stretch of a hint's axis, where very many are local to
// it.
struct VesselField::Vicinity {
  struct Near {
    Index cone;
    double distance;  // of `center`, less the widest blend
  };

  std::uint64_t field = 0;
  Index hint = kNone;
  std::size_t stretch = 0, stretches = 1;
  double most = 0;  // `distance` up to which cones are listed, mm
  Vec3 center = Vec3::Zero();
  std::vector<Near> cones;  // ascending
};

const VesselField::Vicinity& VesselField::vicinity(Index hint, double t) const {
  thread_local std::vector<Vicinity> kept(kKeptVicinities);
  const Cone& own = cones_[hint];
  const double stretches = std::ceil(own.axis.norm() / (kStretch * max_radius(hint)));
  const auto count = static_cast<std::size_t>(std::clamp(stretches, 1.0, kMostStretches));
  const std::size_t stretch = std::min(static_cast<std::size_t>(t * static_cast<double>(count)), count - 1);
  Vicinity& v = kept[(std::size_t{hint} * kSpread + stretch) % kKeptVicinities];
  if (v.field == number_ && v.hint == hint && v.stretch == stretch) return v;
  v.field = number_;
  v.hint = hint;
  v.stretch = stretch;
  v.stretches = count;
  survey_vicinity(v);
  return v;
}

// Distances change by no more than the way from one point to another.
void VesselField::survey_vicinity(Vicinity& v) const {
  const Cone& own = cones_[v.hint];
  const double t0 = static_cast<double>(v.stretch) / static_cast<double>(v.stretches);
  const double t1 = static_cast<double>(v.stretch + 1) / static_cast<double>(v.stretches);
  v.center = own.origin + 0.5 * (t0 + t1) * own.axis;
  const double beside = kBeside * max_radius(v.hint);
  const double away = 0.5 * (t1 - t0) * own.axis.norm() + max_radius(v.hint) + beside;
  const double most = v.most = away + beside + kIndexRounding * (v.center.norm() + away);
  thread_local std::vector<Index> near;
  near.clear();
  visit_near(v.center, most, [&](Index c) { near.push_back(c); });
  keep_listed(relations_.local_cones(v.hint), near);
  v.cones.clear();
  for (const Index c : near) {
    const double distance = cones_[c].distance_to(v.center).value - 2 * blend_ * max_radius(c);
    if (distance <= most) v.cones.push_back({c, distance});
  }
}

// Same as blended(p, local_cones(hint), hint).
FieldSample VesselField::blended_local(const Vec3& p, Index hint) const {
  const std::span<const Index> local = relations_.local_cones(hint);
  if (local.size() <= kFewCones) return blended(p, local, hint);
  thread_local std::vector<Index> near;
  near.clear();
  const double rounding = kIndexRounding * p.norm();
  const Distance own = cones_[hint].distance_to(p);
  double limit = own.value + rounding;
  if (own.value <= 2 * kBeside * max_radius(hint)) {
    const Vicinity& v = vicinity(hint, own.t);
    const double most = limit + (p - v.center).norm() + rounding;
    if (most <= v.most) {
      for (const auto& [c, distance] : v.cones) {
        if (distance <= most) near.push_back(c);
      }
      return blended(p, near, hint);
    }
  }
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
