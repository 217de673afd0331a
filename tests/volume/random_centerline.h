#pragma once

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "vmesh/centerline/centerline.h"

#include "draw.h"

namespace vmesh::testing {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();

/// A random graph: loops, several components, isolated nodes, spheres that contain their neighbours.
inline Centerline random_graph(Draw& draw, Index node_count) {
  std::vector<CenterlineNode> nodes;
  for (Index n = 0; n < node_count; ++n) nodes.push_back({draw.in_cube(4), draw.uniform(0.1, 2)});
  std::set<std::pair<Index, Index>> edges;
  for (Index i = 0; i < node_count; ++i) {
    const Index a = draw.below(node_count), b = draw.below(node_count);
    if (a != b) edges.insert(std::minmax(a, b));
  }
  std::vector<CenterlineSegment> segments;
  for (const auto& [a, b] : edges)
    segments.push_back(draw.chance(0.5) ? CenterlineSegment{a, b} : CenterlineSegment{b, a});
  draw.shuffle(segments);
  return Centerline(std::move(nodes), std::move(segments));
}

/// A random graph on a grid of unit or `pitch` spacing, all radii equal: distances tie.
inline Centerline random_grid_graph(Draw& draw, Index node_count, double pitch) {
  std::set<std::array<Index, 3>> places;
  while (places.size() < node_count) {
    const Index x = draw.below(4), y = draw.below(4), z = draw.below(4);
    places.insert({x, y, z});
  }
  std::vector<CenterlineNode> nodes;
  for (const auto& [x, y, z] : places) nodes.push_back({pitch * Vec3(x, y, z), 0.3 * pitch});
  draw.shuffle(nodes);
  std::set<std::pair<Index, Index>> edges;
  for (Index i = 0; i < node_count; ++i) {
    const Index a = draw.below(node_count), b = draw.below(node_count);
    if (a != b) edges.insert(std::minmax(a, b));
  }
  std::vector<CenterlineSegment> segments;
  for (const auto& [a, b] : edges) segments.push_back({a, b});
  draw.shuffle(segments);
  return Centerline(std::move(nodes), std::move(segments));
}

/// Adds a polyline of the given nodes from node `from` (or on its own) and returns its last node.
struct CenterlineBuilder {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;

  Index add(const Vec3& position, double radius, Index from = kNone) {
    nodes.push_back({position, radius});
    const auto n = static_cast<Index>(nodes.size() - 1);
    if (from != kNone) segments.push_back({from, n});
    return n;
  }
  Centerline build() const { return Centerline(nodes, segments); }
};

/// The least distance to any of `cones`, ties to the first; `cones` ascending.
template <class Field, class Cones>
auto closest_of(const Field& field, const Vec3& p, const Cones& cones) {
  auto best = field.sample_cone(p, *cones.begin());
  for (const Index c : cones) {
    const auto s = field.sample_cone(p, c);
    if (s.distance < best.distance) best = s;
  }
  return best;
}

template <class Field>
std::vector<Index> all_cones(const Field& field) {
  std::vector<Index> cones(field.relations().cone_count());
  for (Index c = 0; c < cones.size(); ++c) cones[c] = c;
  return cones;
}

}  // namespace vmesh::testing
