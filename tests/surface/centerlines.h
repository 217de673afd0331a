#pragma once

#include <cmath>
#include <random>

#include "vmesh/centerline/centerline.h"

namespace vmesh::testing {

inline Centerline single_node() { return {{{{1, 2, 3}, 2}}, {}}; }

inline Centerline straight_tube() { return {{{{0, 0, 0}, 1}, {{4, 0, 0}, 1.2}, {{8, 0, 0}, 1}}, {{0, 1}, {1, 2}}}; }

// A trunk along x that forks at `angle_deg` between its daughters.
inline Centerline fork(double angle_deg = 70) {
  const double half = angle_deg / 2 * M_PI / 180;
  const Vec3 up(std::cos(half), std::sin(half), 0), down(std::cos(half), -std::sin(half), 0);
  return {{{{-8, 0, 0}, 1.5}, {{0, 0, 0}, 1.5}, {5 * up, 1.1}, {10 * up, 1}, {5 * down, 1}, {10 * down, 0.8}},
          {{0, 1}, {1, 2}, {2, 3}, {1, 4}, {4, 5}}};
}

// Arms from one node, evenly spread over the sphere (spherical Fibonacci points).
inline Centerline star(int arms) {
  std::vector<CenterlineNode> nodes = {{{0, 0, 0}, 1}};
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i < arms; ++i) {
    const double z = 1 - (2 * i + 1.0) / arms, angle = i * M_PI * (3 - std::sqrt(5.0));
    const double s = std::sqrt(1 - z * z);
    nodes.push_back({12 * Vec3(s * std::cos(angle), s * std::sin(angle), z), 0.6});
    segments.push_back({0, static_cast<Index>(i + 1)});
  }
  return {std::move(nodes), std::move(segments)};
}

inline Centerline ring(int count) {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    nodes.push_back({10 * Vec3(std::cos(angle), std::sin(angle), 0), 1});
    segments.push_back({static_cast<Index>(i), static_cast<Index>((i + 1) % count)});
  }
  return {std::move(nodes), std::move(segments)};
}

inline Centerline two_forks() {
  const Centerline one = fork();
  std::vector<CenterlineNode> nodes = one.nodes();
  std::vector<CenterlineSegment> segments = one.segments();
  const auto offset = static_cast<Index>(nodes.size());
  for (const auto& node : one.nodes()) nodes.push_back({node.position + Vec3(0, 0, 30), 0.7 * node.radius});
  for (const auto& s : one.segments()) segments.push_back({s.a + offset, s.b + offset});
  return {std::move(nodes), std::move(segments)};
}

inline Centerline transformed(const Centerline& centerline, const Eigen::Matrix3d& rotation, const Vec3& shift,
                              double scale) {
  std::vector<CenterlineNode> nodes = centerline.nodes();
  for (auto& node : nodes) node = {scale * (rotation * node.position + shift), scale * node.radius};
  return {std::move(nodes), centerline.segments()};
}

}  // namespace vmesh::testing
