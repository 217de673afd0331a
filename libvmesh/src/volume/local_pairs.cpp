#include "volume/local_pairs.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vmesh {
namespace {

constexpr double kSampling = 0.5;         // mean radii between two spheres that stand for a cone
constexpr int kMaxSamples = 200;          // per cone
constexpr std::size_t kManySegments = 8;  // at a node: from there on it pays to note what it was joined to

// Spheres at all nodes and along all segments: first those of the nodes, then those within segments in turn.
class SphereChain {
 public:
  explicit SphereChain(const Centerline& centerline) : centerline_(centerline) {
    for (const auto& node : centerline.nodes()) spheres_.push_back({node.position, node.radius});
    for (Index s = 0; s < centerline.segments().size(); ++s) {
      first_.push_back(size());
      const double steps = std::ceil(centerline.length(s) / (kSampling * centerline.radius_at(s, 0.5)));
      const int count = static_cast<int>(std::clamp(steps, 1.0, double{kMaxSamples}));
      for (int k = 1; k < count; ++k) {
        const double t = static_cast<double>(k) / count;
        spheres_.push_back({centerline.point_at(s, t), centerline.radius_at(s, t)});
        segments_.push_back(s);
      }
    }
    first_.push_back(size());
  }

  Index size() const { return static_cast<Index>(spheres_.size()); }

  // The segments of which sphere `p` is part: several at a node.
  std::span<const Index> segments(Index p) const {
    return p < nodes() ? centerline_.incident_segments(p) : std::span(&segments_[p - nodes()], 1);
  }

  // Calls visit(sphere) for the spheres next to `p` along the centerline.
  template <class Visit>
  void visit_next(Index p, Visit&& visit) const {
    for (const Index s : segments(p)) {
      const Index last = first_[s + 1] - first_[s] + 1;
      const Index place = p >= nodes() ? p - first_[s] + 1 : p == centerline_.segment(s).a ? 0 : last;
      if (place > 0) visit(sphere_at(s, place - 1));
      if (place < last) visit(sphere_at(s, place + 1));
    }
  }

  bool touch(Index p, Index q, const Touch& touch) const {
    const double r = spheres_[p].radius, s = spheres_[q].radius, reach = r + s + touch.gap(r, s);
    return (spheres_[p].center - spheres_[q].center).squaredNorm() < reach * reach;
  }

 private:
  struct Sphere {
    Vec3 center;
    double radius;
  };

  Index nodes() const { return static_cast<Index>(centerline_.nodes().size()); }

  // Along segment `s`, whose first node has place 0.
  Index sphere_at(Index s, Index place) const {
    const auto& [a, b] = centerline_.segment(s);
    const Index within = first_[s] + place - 1;
    return place == 0 ? a : within < first_[s + 1] ? within : b;
  }

  const Centerline& centerline_;
  std::vector<Sphere> spheres_;
  std::vector<Index> first_;     // of the spheres within every segment; one more for the end
  std::vector<Index> segments_;  // of spheres within segments
};

}  // namespace

PairSet local_pairs(const Centerline& centerline, const Touch& touch) {
  const SphereChain chain(centerline);
  PairSet touching, set;
  const auto note = [&](Index p, Index q) {
    if (p != q && chain.touch(p, q, touch)) touching.insert(p, q);
  };
  PairSet joined;  // nodes of many branches and the segments that were joined to all of these
  const auto join_one = [&](Index p, Index j) {
    const auto segments = chain.segments(p);
    if (segments.size() > kManySegments && !joined.insert(p, chain.size() + j)) return;
    for (const Index i : segments) {
      if (i != j) set.insert(i, j);
    }
  };
  const auto join = [&](Index p, Index q) {
    if (chain.segments(p).size() < chain.segments(q).size()) std::swap(p, q);
    for (const Index j : chain.segments(q)) join_one(p, j);
  };
  for (Index p = 0; p < chain.size(); ++p) {
    join(p, p);
    chain.visit_next(p, [&](Index q) {
      note(p, q);
      chain.visit_next(p, [&](Index other) { note(q, other); });
    });
  }
  for (std::size_t n = 0; n < touching.pairs().size(); ++n) {
    const auto [p, q] = touching.pairs()[n];
    join(p, q);
    chain.visit_next(p, [&](Index next) { note(next, q); });
    chain.visit_next(q, [&](Index next) { note(p, next); });
  }
  return set;
}

}  // namespace vmesh
