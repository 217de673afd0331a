// Random vessels as from segmentations, around which surfaces must be sound.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

#include "draw.h"

namespace vmesh::testing {

namespace detail {

/// `way`, turned by about `angle` in a random direction.
inline Vec3 turned(Draw& draw, const Vec3& way, double angle) {
  const Vec3 across = draw.across(way);
  return (std::cos(angle) * way + std::sin(angle) * across).normalized();
}

}  // namespace detail

/// A tree like those of BraVa: nodes on a coarse grid, three radii, sharp turns. 20 to 300 nodes.
inline Centerline noisy_tree(std::uint32_t seed) {
  constexpr double kGrid = 0.31, kTurn = 0.55, kBranching = 0.08;
  Draw draw(seed);
  const Index count = 20 + draw.below(281);
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<Vec3> ways;
  std::set<std::pair<std::pair<long, long>, long>> taken;
  const auto on_grid = [&](const Vec3& p) -> Vec3 { return kGrid * (p / kGrid).array().round().matrix(); };
  const auto claim = [&](const Vec3& p) {
    const Eigen::Array3d at = (p / kGrid).array().round();
    return taken.insert({{std::lround(at.x()), std::lround(at.y())}, std::lround(at.z())}).second;
  };
  const auto radius = [&] { return kGrid * (1 + draw.below(3)); };
  nodes.push_back({Vec3::Zero(), radius()});
  ways.push_back(draw.direction());
  claim(Vec3::Zero());
  std::vector<Index> tips = {0};
  while (nodes.size() < count) {
    const Index tip = draw.below(static_cast<Index>(tips.size())), from = tips[tip];
    const double angle = kTurn * std::abs(draw.uniform(-1, 1) + draw.uniform(-1, 1) + draw.uniform(-1, 1));
    const Vec3 way = detail::turned(draw, ways[from], angle);
    const Vec3 position = on_grid(nodes[from].position + draw.uniform(1.2, 4.5) * way);
    if (!claim(position)) continue;
    segments.push_back({from, static_cast<Index>(nodes.size())});
    ways.push_back((position - nodes[from].position).normalized());
    const auto next = static_cast<Index>(nodes.size());
    nodes.push_back({position, radius()});
    if (draw.chance(kBranching)) {
      tips.push_back(next);
    } else {
      tips[tip] = next;
    }
  }
  return Centerline(std::move(nodes), std::move(segments));
}

/// A tree with 3 to 13 places where 1 to 3 children leave, each .3 to 1 of its parent's radius; steps of .4 to 4 radii.
/// `loops` pairs of its nodes are joined.
inline Centerline plausible_tree(std::uint32_t seed, int loops = 0) {
  Draw draw(seed);
  struct Tip {
    Index node;
    Vec3 way;
    double radius;
  };
  std::vector<CenterlineNode> nodes = {{Vec3::Zero(), draw.uniform(1, 4)}};
  std::vector<CenterlineSegment> segments;
  const auto grow = [&](Tip tip) {
    const Index steps = 2 + draw.below(5);
    for (Index k = 0; k < steps; ++k) {
      tip.way = detail::turned(draw, tip.way, draw.uniform(0, 0.35));
      const Vec3 position = nodes[tip.node].position + draw.uniform(0.4, 4) * tip.radius * tip.way;
      const auto next = static_cast<Index>(nodes.size());
      nodes.push_back({position, tip.radius * draw.uniform(0.85, 1.1)});
      segments.push_back({tip.node, next});
      tip.node = next;
    }
    return tip;
  };
  std::vector<Tip> tips = {grow({0, draw.direction(), nodes[0].radius})};
  const Index forks = 3 + draw.below(11);
  for (Index f = 0; f < forks; ++f) {
    const Index from = draw.below(static_cast<Index>(tips.size()));
    const Tip parent = tips[from];
    tips.erase(tips.begin() + from);
    const Index children = 1 + draw.below(3);
    for (Index c = 0; c < children; ++c) {
      const Vec3 way = detail::turned(draw, parent.way, draw.uniform(0.2, 1.2));
      tips.push_back(grow({parent.node, way, parent.radius * draw.uniform(0.3, 1)}));
    }
  }
  std::set<std::pair<Index, Index>> joined;
  for (const auto& [a, b] : segments) joined.insert(std::minmax(a, b));
  for (int l = 0; l < loops; ++l) {
    const Index a = draw.below(static_cast<Index>(nodes.size())), b = draw.below(static_cast<Index>(nodes.size()));
    if (a != b && joined.insert(std::minmax(a, b)).second) segments.push_back({a, b});
  }
  return Centerline(std::move(nodes), std::move(segments));
}

/// A tree whose steps are mostly shorter than its vessels are thick, with radii that fall by up to five at a step, down
/// to a two hundredth: thin vessels leave thick ones within the rounding between these. 30 to 60 nodes.
inline Centerline short_thick_tree(std::uint32_t seed) {
  constexpr double kBranching = 0.2, kNarrowing = 0.3, kThinnest = 0.02;
  Draw draw(seed);
  const Index count = 30 + draw.below(31);
  std::vector<CenterlineNode> nodes = {{Vec3::Zero(), draw.uniform(2.5, 4)}};
  std::vector<CenterlineSegment> segments;
  std::vector<Vec3> ways = {draw.direction()};
  std::vector<Index> tips = {0};
  while (nodes.size() < count) {
    const Index tip = draw.below(static_cast<Index>(tips.size())), from = tips[tip];
    const double parent = nodes[from].radius;
    const Vec3 way = detail::turned(draw, ways[from], draw.uniform(0, 0.8));
    const double share = draw.chance(kNarrowing) ? draw.uniform(0.2, 0.6) : draw.uniform(0.75, 1.05);
    const auto next = static_cast<Index>(nodes.size());
    nodes.push_back(
        {nodes[from].position + draw.uniform(0.1, 1.8) * parent * way, std::max(kThinnest, share * parent)});
    segments.push_back({from, next});
    ways.push_back(way);
    if (draw.chance(kBranching)) {
      tips.push_back(next);
    } else {
      tips[tip] = next;
    }
  }
  return Centerline(std::move(nodes), std::move(segments));
}

}  // namespace vmesh::testing
