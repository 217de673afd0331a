#include "vmesh/mesh/triangle_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vmesh {
namespace {

double angle(const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

}  // namespace

double equiangle_skewness(const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kThird = std::numbers::pi / 3;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  if (ab.isZero(0) || bc.isZero(0) || ca.isZero(0)) return 1;
  const double at_a = angle(ab, -ca), at_b = angle(bc, -ab), at_c = angle(ca, -bc);
  const double high = std::max({at_a, at_b, at_c}), low = std::min({at_a, at_b, at_c});
  return std::clamp(std::max((high - kThird) / (2 * kThird), (kThird - low) / kThird), 0.0, 1.0);
}

std::vector<double> equiangle_skewness(const TriMesh& mesh) {
  std::vector<double> skewness;
  skewness.reserve(mesh.faces.size());
  for (const auto& [a, b, c] : mesh.faces) {
    skewness.push_back(equiangle_skewness(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  }
  return skewness;
}

SkewnessSummary summarize_skewness(const TriMesh& mesh) {
  SkewnessSummary summary;
  for (const double s : equiangle_skewness(mesh)) {
    summary.mean += s;
    summary.max = std::max(summary.max, s);
  }
  if (!mesh.faces.empty()) summary.mean /= static_cast<double>(mesh.faces.size());
  return summary;
}

}  // namespace vmesh
