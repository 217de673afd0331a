#include "vmesh/mesh/triangle_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/blocks.h"

namespace vmesh {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Quantities common to all corners, or that need the corners ranked by their opposite edges.
struct TriangleShape {
  TriangleShape(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 edges[3] = {c - b, a - c, b - a};  // opposite to a, b, c
    for (int i = 0; i < 3; ++i) squared[i] = edges[i].squaredNorm();
    longest = squared[0] >= squared[1] ? (squared[0] >= squared[2] ? 0 : 2) : (squared[1] >= squared[2] ? 1 : 2);
    shortest = squared[0] < squared[1] ? (squared[0] < squared[2] ? 0 : 2) : (squared[1] < squared[2] ? 1 : 2);
    // The cross product of the two shorter edges is the most accurate.
    twice_area = edges[kNext[longest]].cross(edges[kNext[longest + 1]]).norm();
    dot_at_max = -edges[kNext[longest]].dot(edges[kNext[longest + 1]]);
    dot_at_min = -edges[kNext[shortest]].dot(edges[kNext[shortest + 1]]);
  }

  bool corners_coincide() const { return !(squared[shortest] > 0); }
  // The least angle is acute; the largest is not small. An arc tangent costs half as much as one of two arguments.
  double min_angle() const { return corners_coincide() ? 0 : std::atan(twice_area / dot_at_min); }
  double max_angle() const {
    return corners_coincide() ? std::numbers::pi : std::numbers::pi / 2 - std::atan(dot_at_max / twice_area);
  }

  static constexpr int kNext[4] = {1, 2, 0, 1};
  double squared[3];  // lengths of the edges
  int shortest, longest;
  double twice_area, dot_at_min, dot_at_max;
};

// The least angle decides: the largest is at most 180 degrees less twice the least, so that (max - 60) / 120 is at most
// (60 - min) / 60.
double skewness_of(double min_angle) { return std::clamp(1 - min_angle / (std::numbers::pi / 3), 0.0, 1.0); }

}  // namespace

TriangleMeasures measure_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const TriangleShape shape(a, b, c);
  const double min_angle = shape.min_angle(), max_angle = shape.max_angle();
  TriangleMeasures measures;
  measures.area_mm2 = shape.twice_area / 2;
  measures.min_angle_deg = kDegrees * min_angle;
  measures.max_angle_deg = kDegrees * max_angle;
  measures.equiangle_skewness = skewness_of(min_angle);
  if (shape.corners_coincide()) return measures;
  const double lengths[3] = {std::sqrt(shape.squared[0]), std::sqrt(shape.squared[1]), std::sqrt(shape.squared[2])};
  const double shortest = lengths[shape.shortest], longest = lengths[shape.longest];
  const double inradius = shape.twice_area / (lengths[0] + lengths[1] + lengths[2]);
  measures.shortest_to_longest_edge = shortest / longest;
  measures.double_inradius_to_circumradius = 4 * inradius * shape.twice_area / (lengths[0] * lengths[1] * lengths[2]);
  measures.scaled_inradius_to_longest_edge = 2 * std::numbers::sqrt3 * inradius / longest;
  return measures;
}

double equiangle_skewness(const Vec3& a, const Vec3& b, const Vec3& c) {
  return skewness_of(TriangleShape(a, b, c).min_angle());
}

std::vector<double> equiangle_skewness(const TriMesh& mesh) {
  std::vector<double> skewness(mesh.faces.size());
  for_blocks(skewness.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto& [a, b, c] = mesh.faces[f];
      skewness[f] = equiangle_skewness(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    }
  });
  return skewness;
}

SkewnessSummary summarize_skewness(const TriMesh& mesh) { return summarize_skewness(equiangle_skewness(mesh)); }

SkewnessSummary summarize_skewness(const std::vector<double>& skewness) {
  SkewnessSummary summary;
  for (const double s : skewness) {
    summary.mean += s;
    summary.max = std::max(summary.max, s);
  }
  if (!skewness.empty()) summary.mean /= static_cast<double>(skewness.size());
  return summary;
}

}  // namespace vmesh
