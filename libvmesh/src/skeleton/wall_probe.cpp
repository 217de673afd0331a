#include "wall_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vmesh::skeleton {
namespace {

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? a + std::clamp((p - a).dot(along) / length2, 0.0, 1.0) * along : a;
}

Vec3 nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& corner) {
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double length2 = normal.squaredNorm();
  bool above = length2 > 0;
  for (std::size_t i = 0; above && i < 3; ++i) {
    const Vec3& a = corner[i];
    above = (corner[(i + 1) % 3] - a).cross(p - a).dot(normal) >= 0;
  }
  if (above) return p - (p - corner[0]).dot(normal) / length2 * normal;
  Vec3 best = nearest_on_segment(p, corner[0], corner[1]);
  for (std::size_t i = 1; i < 3; ++i) {
    const Vec3 other = nearest_on_segment(p, corner[i], corner[(i + 1) % 3]);
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  }
  return best;
}

bool segment_meets(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& corner) {
  const Vec3 e = corner[1] - corner[0], f = corner[2] - corner[0], along = to - from;
  const Vec3 h = along.cross(f);
  const double det = e.dot(h);
  if (det == 0) return false;
  const Vec3 s = from - corner[0];
  const double u = s.dot(h) / det;
  const Vec3 q = s.cross(e);
  const double v = along.dot(q) / det, t = f.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

std::array<Vec3, 3> corners_of(const TriMesh& mesh, Index f) {
  const auto& [a, b, c] = mesh.faces[f];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

}  // namespace

WallProbe::WallProbe(const TriMesh& mesh) : mesh_(mesh) {
  tree_ = BoxTree(static_cast<Index>(mesh.faces.size()), [&](Index f) {
    const auto [a, b, c] = corners_of(mesh, f);
    return BoxTree::Box{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  });
}

WallProbe::Nearest WallProbe::nearest(const Vec3& p) const {
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  tree_.visit(p, best.distance, [&](Index f) {
    const Vec3 point = nearest_on_triangle(p, corners_of(mesh_, f));
    const double distance = (point - p).norm();
    if (!(distance < best.distance)) return;
    best.face = f;
    best.point = point;
    best.distance = distance;
  });
  return best;
}

bool WallProbe::meets(const Vec3& from, const Vec3& to) const {
  bool met = false;
  tree_.visit_overlapping(from.cwiseMin(to), from.cwiseMax(to),
                          [&](Index f) { met = met || segment_meets(from, to, corners_of(mesh_, f)); });
  return met;
}

}  // namespace vmesh::skeleton
