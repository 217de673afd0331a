#pragma once

#include <span>
#include <vector>

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// The segments that begin at one node of very many (a hub) form a fan: all of them are local to each other, so no
/// pairs of them are listed.
///
/// Straight and beginning with one sphere, two of them part once: where two of their spheres are in touch, those before
/// them are as well, since the distance shrinks towards the hub as the segments do, and radii and gaps by no more.
class Fans {
 public:
  /// Segments at a hub. Measured on stars: below 64, listing pairs is as fast.
  static constexpr std::size_t kLeastSegments = 64;

  explicit Fans(const Centerline& centerline) {
    for (Index n = 0; n < centerline.nodes().size(); ++n) {
      if (is_hub(centerline, n)) add(centerline, n);
    }
  }

  bool empty() const { return hubs_.empty(); }
  std::span<const Index> hubs() const { return hubs_; }
  /// The hub at which a segment begins; kNone at none or two.
  Index hub_of(Index segment) const { return hub_of_.empty() ? kNone : hub_of_[segment]; }
  bool are_in_one(Index i, Index j) const { return hub_of(i) != kNone && hub_of(i) == hub_of(j); }

 private:
  static bool is_hub(const Centerline& centerline, Index node) { return centerline.degree(node) >= kLeastSegments; }

  void add(const Centerline& centerline, Index hub) {
    hubs_.push_back(hub);
    hub_of_.resize(centerline.segments().size(), kNone);
    for (const Index s : centerline.incident_segments(hub)) {
      if (!is_hub(centerline, centerline.other_node(s, hub))) hub_of_[s] = hub;
    }
  }

  std::vector<Index> hubs_;
  std::vector<Index> hub_of_;  // of every segment; empty if there are no hubs
};

}  // namespace vmesh
