// Centerlines that take longest for their size: everything in one junction, or no tube anywhere.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "vmesh/centerline/centerline.h"

#include "draw.h"

namespace vmesh::testing {

namespace detail {

// Straight branches of radius 0.5 in all directions from one node, as many segments each.
inline Centerline star_of(int branches, double length, int segments_each) {
  constexpr double kRadius = 0.5;
  std::vector<CenterlineNode> nodes = {{Vec3::Zero(), kRadius}};
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i < branches; ++i) {
    const double z = 1 - (2.0 * i + 1) / branches, angle = i * std::numbers::pi * (3 - std::sqrt(5));
    const double across = std::sqrt(1 - z * z);
    Index last = 0;
    for (int k = 1; k <= segments_each; ++k) {
      const double t = static_cast<double>(k) / segments_each;
      nodes.push_back({t * length * Vec3(across * std::cos(angle), across * std::sin(angle), z), kRadius});
      segments.push_back({last, static_cast<Index>(nodes.size() - 1)});
      last = segments.back().b;
    }
  }
  return {nodes, segments};
}

}  // namespace detail

/// Equal branches of one node, 120 radii long, spread evenly in all directions.
inline Centerline star(int branches) { return detail::star_of(branches, 60, 3); }
/// The same, but ending soon after the branches have parted, so that it is little more than its hub.
inline Centerline short_star(int branches) { return detail::star_of(branches, 0.4 * std::sqrt(branches) + 6, 2); }

namespace detail {

template <class Step, class Radius>
Centerline line_of(int count, const Step& step, const Radius& radius) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  Vec3 at = Vec3::Zero();
  for (int i = 0; i < count; ++i) {
    nodes.push_back({at, radius()});
    if (i > 0) segments.push_back({static_cast<Index>(i - 1), static_cast<Index>(i)});
    at += step();
  }
  return {nodes, segments};
}

}  // namespace detail

/// A line of nodes of random radii from .05 to 3, mostly within each other; it drifts, so that it does not meet itself.
inline Centerline uneven_chain(int count, std::uint32_t seed) {
  Draw draw(seed);
  return detail::line_of(
      count, [&] { return Vec3(draw.uniform(0.5, 3) * (0.8 * draw.direction() + Vec3::UnitX())); },
      [&] { return draw.uniform(0.05, 3); });
}

/// A random walk in steps of two to four diameters, also through itself.
inline Centerline random_walk(int count, std::uint32_t seed) {
  Draw draw(seed);
  return detail::line_of(
      count, [&] { return Vec3(2 * draw.direction()); }, [&] { return draw.uniform(0.3, 0.6); });
}

}  // namespace vmesh::testing
