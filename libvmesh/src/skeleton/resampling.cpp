#include <algorithm>
#include <cmath>

#include "skeleton_graph.h"

namespace vmesh::skeleton {
namespace {

/// A chain as a curve: nodes at distances from its start.
struct Curve {
  std::vector<Node> nodes;
  std::vector<double> at;
};

Curve curve_of(const Graph& graph, const Chain& chain) {
  Curve curve;
  double at = 0;
  for (std::size_t i = 0; i < chain.nodes.size(); ++i) {
    if (i > 0) at += graph.length(chain.edges[i - 1]);
    curve.nodes.push_back(graph.nodes[chain.nodes[i]]);
    curve.at.push_back(at);
  }
  return curve;
}

Node node_at(const Curve& curve, double at) {
  const auto after = std::upper_bound(curve.at.begin(), curve.at.end(), at);
  if (after == curve.at.begin()) return curve.nodes.front();
  if (after == curve.at.end()) return curve.nodes.back();
  const auto i = static_cast<std::size_t>(after - curve.at.begin());
  const double t = (at - curve.at[i - 1]) / (curve.at[i] - curve.at[i - 1]);
  const Node &a = curve.nodes[i - 1], &b = curve.nodes[i];
  return {(1 - t) * a.position + t * b.position, (1 - t) * a.radius + t * b.radius, 0, a.component};
}

/// The mean over half a radius to both sides, less near the ends, which stay fixed.
Node smoothed_at(const Curve& curve, double at, double radius) {
  constexpr int kSamples = 4;
  const double reach = std::min({0.5 * radius, at, curve.at.back() - at});
  Node sum{Vec3::Zero(), 0};
  for (int i = -kSamples; i <= kSamples; ++i) {
    const Node node = node_at(curve, at + reach * i / kSamples);
    sum.position += node.position;
    sum.radius += node.radius;
  }
  return {sum.position / (2 * kSamples + 1), sum.radius / (2 * kSamples + 1), 0, curve.nodes.front().component};
}

/// Distances from the start, spaced evenly in radii, both ends included.
std::vector<double> divisions(const Curve& curve, double spacing, double least_radius, std::size_t least) {
  std::vector<double> radii(curve.at.size(), 0);  // length in radii up to every node
  for (std::size_t i = 1; i < curve.at.size(); ++i)
    radii[i] = radii[i - 1] +
               2 * (curve.at[i] - curve.at[i - 1]) /
                   (std::max(curve.nodes[i - 1].radius, least_radius) + std::max(curve.nodes[i].radius, least_radius));
  if (!(radii.back() > 0)) return {0, curve.at.back()};
  const auto count = std::max(least, static_cast<std::size_t>(std::lround(radii.back() / spacing)));
  std::vector<double> places = {0};
  std::size_t i = 1;
  for (std::size_t n = 1; n < count; ++n) {
    const double wanted = radii.back() * static_cast<double>(n) / static_cast<double>(count);
    while (radii[i] < wanted) ++i;
    const double t = (wanted - radii[i - 1]) / (radii[i] - radii[i - 1]);
    places.push_back(curve.at[i - 1] + t * (curve.at[i] - curve.at[i - 1]));
  }
  places.push_back(curve.at.back());
  return places;
}

}  // namespace

Graph resampled(const Graph& graph, double spacing, double least) {
  const std::vector<Chain> chains = chains_of(graph);
  std::vector<bool> is_alone(graph.nodes.size(), true);
  for (const auto& [a, b] : graph.edges) is_alone[a] = is_alone[b] = false;
  Graph result;
  std::vector<Index> number(graph.nodes.size(), kNone);
  const auto kept = [&](Index n) {
    if (number[n] == kNone) {
      number[n] = static_cast<Index>(result.nodes.size());
      result.nodes.push_back(graph.nodes[n]);
    }
    return number[n];
  };
  for (const Chain& chain : chains) {
    const Curve curve = curve_of(graph, chain);
    const bool closed = chain.nodes.front() == chain.nodes.back();
    // Two edges between the same nodes would coincide, so every chain gets a node of its own if possible.
    const std::vector<double> places = divisions(curve, spacing, least, closed ? 3 : chain.edges.size() > 1 ? 2 : 1);
    Index before = kept(chain.nodes.front());
    for (std::size_t n = 1; n + 1 < places.size(); ++n) {
      const double radius = node_at(curve, places[n]).radius;
      result.nodes.push_back(smoothed_at(curve, places[n], radius));
      const auto fresh = static_cast<Index>(result.nodes.size() - 1);
      result.edges.push_back({before, fresh});
      before = fresh;
    }
    result.edges.push_back({before, kept(chain.nodes.back())});
  }
  for (Index n = 0; n < graph.nodes.size(); ++n)
    if (number[n] == kNone && is_alone[n]) kept(n);
  return result;
}

}  // namespace vmesh::skeleton
