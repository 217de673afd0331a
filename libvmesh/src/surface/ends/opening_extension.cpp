#include "surface/ends/opening_extension.h"

#include <algorithm>
#include <cmath>

#include "vmesh/surface/disc.h"

#include "surface/tubes/stitch.h"

namespace vmesh {
namespace {

/// The ring turned by half a step: points midway between its own, on the cubic through four of them, scaled to enclose
/// the same area.
std::vector<Vec3> between(const std::vector<Vec3>& ring) {
  const std::size_t count = ring.size();
  std::vector<Vec3> result;
  for (std::size_t j = 0; j < count; ++j) {
    result.push_back((9 * (ring[j] + ring[(j + 1) % count]) - ring[(j + count - 1) % count] - ring[(j + 2) % count]) /
                     16);
  }
  const double scale = std::sqrt(area_vector(ring).norm() / area_vector(result).norm());
  const Vec3 center = area_centroid(ring);
  for (Vec3& p : result) p = center + scale * (p - center);
  return result;
}

}  // namespace

Index add_vertex_like(GenerateResult& result, Index like, const Vec3& position) {
  result.mesh.vertices.push_back(position);
  result.binding.push_back(CenterlineBinding(result.binding[like]));
  result.radius.push_back(double(result.radius[like]));
  return static_cast<Index>(result.mesh.vertices.size() - 1);
}

double mean_edge(const std::vector<Vec3>& ring) {
  double around = 0;
  for (std::size_t j = 0; j < ring.size(); ++j) around += (ring[(j + 1) % ring.size()] - ring[j]).norm();
  return around / static_cast<double>(ring.size());
}

void extend_opening(GenerateResult& result, Opening& opening, const std::vector<Vec3>& target) {
  std::vector<Vec3> start, lower;
  for (const Index v : opening.ring) start.push_back(result.mesh.vertices[v]);
  double length = 0;
  for (std::size_t j = 0; j < start.size(); ++j) length += (target[j] - start[j]).norm();
  length /= static_cast<double>(start.size());
  const double pitch = std::sqrt(3.0) / 2 * mean_edge(start);
  const auto bands = static_cast<std::size_t>(std::max(1.0, std::round(length / pitch)));
  lower = start;
  for (std::size_t k = 1; k <= bands; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(bands);
    std::vector<Vec3> upper = start;
    for (std::size_t j = 0; j < upper.size(); ++j) upper[j] += share * (target[j] - start[j]);
    if (k % 2 == 1) upper = between(upper);
    std::vector<Index> next;
    for (std::size_t j = 0; j < upper.size(); ++j) next.push_back(add_vertex_like(result, opening.ring[j], upper[j]));
    const auto vertex = [&](Index i) { return i < opening.ring.size() ? opening.ring[i] : next[i - next.size()]; };
    for (const auto& [a, b, c] : stitch(lower, upper)) result.mesh.faces.push_back({vertex(a), vertex(b), vertex(c)});
    opening.ring = std::move(next);
    lower = std::move(upper);
  }
}

}  // namespace vmesh
