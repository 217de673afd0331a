#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/core/box_tree.h"

#include "volume/fans.h"
#include "volume/local_pairs.h"

namespace vmesh {

/// Spheres at all nodes and along all segments, a share of the mean radius apart: first those of the nodes, then those
/// within segments, in order.
class SphereChain {
 public:
  SphereChain(const Centerline& centerline, double spacing)
      : centerline_(centerline), spacing_(spacing), fans_(centerline) {
    first_.reserve(centerline.segments().size() + 1);
    std::size_t within = 0;
    for (Index s = 0; s < centerline.segments().size(); ++s) within += static_cast<std::size_t>(steps_along(s) - 1);
    spheres_.reserve(centerline.nodes().size() + within);
    segments_.reserve(within);
    for (const auto& node : centerline.nodes()) spheres_.push_back({node.position, node.radius});
    for (Index s = 0; s < centerline.segments().size(); ++s) {
      first_.push_back(size());
      const int count = steps_along(s);
      for (int k = 1; k < count; ++k) {
        const double t = static_cast<double>(k) / count;
        spheres_.push_back({centerline.point_at(s, t), centerline.radius_at(s, t)});
        segments_.push_back(s);
      }
    }
    first_.push_back(size());
    list_spheres_of_fans();
  }

  Index size() const { return static_cast<Index>(spheres_.size()); }

  Index nodes() const { return static_cast<Index>(centerline_.nodes().size()); }
  const Vec3& center(Index p) const { return spheres_[p].center; }
  double radius(Index p) const { return spheres_[p].radius; }
  /// The gap between two spheres, mm.
  double gap(Index p, Index q) const {
    return (spheres_[p].center - spheres_[q].center).norm() - spheres_[p].radius - spheres_[q].radius;
  }

  /// The segments to which sphere `p` belongs: several at a node.
  std::span<const Index> segments(Index p) const {
    return p < nodes() ? centerline_.incident_segments(p) : std::span(&segments_[p - nodes()], 1);
  }

  /// Calls visit(sphere) for the spheres of a segment, both ends included.
  template <class Visit>
  void visit_spheres(Index segment, Visit&& visit) const {
    visit(centerline_.segment(segment).a);
    for (Index p = first_[segment]; p < first_[segment + 1]; ++p) visit(p);
    visit(centerline_.segment(segment).b);
  }

  /// Calls visit(sphere) for the spheres next to `p` along the centerline.
  template <class Visit>
  void visit_next(Index p, Visit&& visit) const {
    for (const Index s : segments(p)) {
      const Index last = first_[s + 1] - first_[s] + 1;
      const Index place = p >= nodes() ? p - first_[s] + 1 : p == centerline_.segment(s).a ? 0 : last;
      if (place > 0) visit(sphere_at(s, place - 1));
      if (place < last) visit(sphere_at(s, place + 1));
    }
  }

  /// Calls visit(p', q') for the pairs of spheres next to the pair p, q.
  template <class Visit>
  void visit_next_pairs(Index p, Index q, Visit&& visit) const {
    visit_next(p, [&](Index next) { visit(next, q); });
    visit_next(q, [&](Index next) { visit(p, next); });
  }

  bool touch(Index p, Index q, const Touch& touch) const {
    const double r = spheres_[p].radius, s = spheres_[q].radius, reach = r + s + touch.gap(r, s);
    return (spheres_[p].center - spheres_[q].center).squaredNorm() < reach * reach;
  }

  const Fans& fans() const { return fans_; }

  /// Whether both belong to one fan, and to nothing else but its hub: such pairs are not listed.
  bool are_in_one_fan(Index p, Index q) const {
    if (fans_.empty()) return false;
    const Index hub = fan_at(p);
    return hub != kNone && hub == fan_at(q) && (p != hub || q != hub);
  }

  /// Whether sphere `q` belongs to a segment of the fan at `hub`, its far end included.
  bool is_in_fan_of(Index q, Index hub) const {
    if (fans_.empty() || hub >= nodes()) return false;
    return std::ranges::any_of(segments(q), [&](Index s) { return fans_.hub_of(s) == hub; });
  }

  /// Calls visit(p, q) for the ends p of a fan's segments and the spheres q of its other segments that touch them.
  template <class Visit>
  void visit_touching_ends(const Touch& touching, Visit&& visit) const {
    for (const Index hub : fans_.hubs()) {
      for (const Index s : centerline_.incident_segments(hub)) {
        if (fans_.hub_of(s) != hub) continue;
        const Index end = centerline_.other_node(s, hub);
        if (touch(end, hub, touching)) visit(end, hub);
        const double around = radius(end) + touching.gap(radius(end), widest_in_fans_);
        fan_tree_.visit_overlapping(center(end).array() - around, center(end).array() + around, [&](Index item) {
          const FanSphere& other = fan_spheres_[item];
          if (fans_.hub_of(other.segment) != hub || other.segment == s || other.sphere == end) return;
          if (touch(end, other.sphere, touching)) visit(end, other.sphere);
        });
      }
    }
  }

  /// Whether a point is within a sphere of the fan at `hub`, other than the hub's own.
  bool is_in_fan(const Vec3& x, Index hub) const {
    bool inside = false;
    fan_tree_.visit_overlapping(x, x, [&](Index item) {
      const auto& [segment, p] = fan_spheres_[item];
      inside = inside || (fans_.hub_of(segment) == hub && (center(p) - x).squaredNorm() <= radius(p) * radius(p));
    });
    return inside;
  }

 private:
  static constexpr int kMaxSamples = 200;  // per cone; safe 140 to 280

  struct Sphere {
    Vec3 center;
    double radius;
  };

  struct FanSphere {
    Index segment, sphere;
  };

  void list_spheres_of_fans() {
    for (const Index hub : fans_.hubs()) {
      for (const Index s : centerline_.incident_segments(hub)) {
        if (fans_.hub_of(s) != hub) continue;
        for (Index p = first_[s]; p < first_[s + 1]; ++p) fan_spheres_.push_back({s, p});
        fan_spheres_.push_back({s, centerline_.other_node(s, hub)});
      }
    }
    for (const FanSphere& one : fan_spheres_) widest_in_fans_ = std::max(widest_in_fans_, radius(one.sphere));
    fan_tree_ = BoxTree(static_cast<Index>(fan_spheres_.size()), [this](Index item) {
      const auto& [middle, around] = spheres_[fan_spheres_[item].sphere];
      return BoxTree::Box{middle.array() - around, middle.array() + around};
    });
  }

  // The hub, or that of the segment within which the sphere is.
  Index fan_at(Index p) const {
    if (p >= nodes()) return fans_.hub_of(segments_[p - nodes()]);
    return centerline_.degree(p) >= Fans::kLeastSegments ? p : kNone;
  }

  int steps_along(Index s) const {
    const double steps = std::ceil(centerline_.length(s) / (spacing_ * centerline_.radius_at(s, 0.5)));
    return static_cast<int>(std::clamp(steps, 1.0, double{kMaxSamples}));
  }

  // The sphere at position `place` along segment `s`, whose first node is position 0.
  Index sphere_at(Index s, Index place) const {
    const auto& [a, b] = centerline_.segment(s);
    const Index within = first_[s] + place - 1;
    return place == 0 ? a : within < first_[s + 1] ? within : b;
  }

  const Centerline& centerline_;
  double spacing_;  // mean radii
  Fans fans_;
  std::vector<FanSphere> fan_spheres_;  // but the hubs
  double widest_in_fans_ = 0;
  BoxTree fan_tree_;
  std::vector<Sphere> spheres_;
  std::vector<Index> first_;     // of the spheres within every segment; one more for the end
  std::vector<Index> segments_;  // of spheres within segments
};

/// All pairs of different spheres in touch that can be reached from two copies of one sphere by moving either along the
/// centerline without losing touch, but for those in one fan (SphereChain::are_in_one_fan). Calls visit_next(p, q), at
/// least once, for the pairs one step further that are not in touch.
PairSet pairs_in_touch(const SphereChain& chain, const Touch& touch,
                       const std::function<void(Index, Index)>& visit_next = {});

/// Collects the pairs of segments of given pairs of spheres, but for those in one fan.
class SegmentPairs {
 public:
  explicit SegmentPairs(const SphereChain& chain) : chain_(chain) {}

  void join(Index p, Index q);
  void join_all(const PairSet& spheres);
  /// The segments at every node.
  void join_at_nodes();
  const PairSet& pairs() const { return pairs_; }
  PairSet take() { return std::move(pairs_); }

 private:
  void join_one(Index p, Index j);

  const SphereChain& chain_;
  PairSet pairs_;
  PairSet joined_;  // nodes of many branches, and the segments joined to all of their branches
};

/// The pairs of segments that share a sphere or belong to one of these pairs, but for those in one fan.
PairSet local_segments(const SphereChain& chain, const PairSet& touching);

}  // namespace vmesh
