#include "volume/local_pairs.h"

#include <algorithm>
#include <cmath>

namespace vmesh {
namespace {

constexpr double kSampling = 0.5;  // mean radii between two spheres that stand for a cone
constexpr int kMaxSamples = 200;   // per cone

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

}  // namespace

PairSet local_pairs(const Centerline& centerline, double touch) {
  const SphereChain chain = make_chain(centerline);
  PairSet touching, set;
  const auto note = [&](Index p, Index q) {
    const double reach = touch * (chain.radii[p] + chain.radii[q]);
    if ((chain.centers[p] - chain.centers[q]).squaredNorm() < reach * reach && p != q) touching.insert(p, q);
  };
  for (Index p = 0; p < chain.centers.size(); ++p) {
    for (const Index i : chain.cones[p]) {
      for (const Index j : chain.cones[p]) {
        if (i != j) set.insert(i, j);
      }
    }
    for (const Index q : chain.next[p]) note(p, q);
    for (std::size_t n = 0; n < chain.next[p].size(); ++n) {
      for (std::size_t m = 0; m < n; ++m) note(chain.next[p][n], chain.next[p][m]);
    }
  }
  for (std::size_t n = 0; n < touching.pairs().size(); ++n) {
    const auto [p, q] = touching.pairs()[n];
    for (const Index i : chain.cones[p]) {
      for (const Index j : chain.cones[q]) {
        if (i != j) set.insert(i, j);
      }
    }
    for (const Index next : chain.next[p]) note(next, q);
    for (const Index next : chain.next[q]) note(p, next);
  }
  return set;
}

}  // namespace vmesh
