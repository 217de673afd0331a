#include "surface/cut/plane_snap.h"

#include <algorithm>
#include <map>
#include <optional>

#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

/// A vertex nearer to the plane than this share of its longest cut edge is moved.
constexpr double kNear = 0.3;
/// Worst skewness that a move may leave where it was not as bad before, and cosine of the turn of a face.
constexpr double kWorstMoved = 0.75, kMostTurned = 0.7;
/// The surface must not lie flatter to the plane than this: the part of its normal in the plane.
constexpr double kFlattest = 0.3;

class Snapper {
 public:
  explicit Snapper(SurfaceAtPlane& surface) : s_(surface) {}

  std::vector<Index> run(const PlaneLoop& loop) {
    std::vector<Index> moved;
    for (const auto& [nearness, v] : candidates(loop))
      if (snap(v)) moved.push_back(v);
    std::sort(moved.begin(), moved.end());
    return moved;
  }

 private:
  /// The nearest first.
  std::vector<std::pair<double, Index>> candidates(const PlaneLoop& loop) const {
    std::map<Index, double> extent;
    for (const auto& [u, v] : loop.edges) {
      const double length = s_.distance[v] - s_.distance[u];
      for (const Index end : {u, v}) extent[end] = std::max(extent[end], length);
    }
    std::vector<std::pair<double, Index>> near;
    for (const auto& [v, length] : extent) {
      const double nearness = std::abs(s_.distance[v]) / length;
      if (nearness < kNear) near.emplace_back(nearness, v);
    }
    std::sort(near.begin(), near.end());
    return near;
  }

  /// Whether a vertex has neighbours on both sides, `but` not counted.
  bool is_between(Index v, Index but) const {
    bool behind = false, before = false;
    for (const Index f : s_.table.faces_around(v)) {
      for (const Index w : s_.table.faces()[f]) {
        if (w == v || w == but) continue;
        behind = behind || s_.distance[w] < 0;
        before = before || s_.distance[w] > 0;
      }
    }
    return behind && before;
  }

  /// Whether the faces of an edge are on different sides.
  bool divides(Index v, Index w) const {
    const auto [left, right] = s_.table.opposite({v, w});
    return left != kNone && right != kNone && s_.distance[left] * s_.distance[right] < 0;
  }

  bool stays_simple(Index v) const {
    if (!s_.table.is_inner(v) || !is_between(v, kNone)) return false;
    for (const Index f : s_.table.faces_around(v)) {
      int in_plane = 0;
      for (const Index w : s_.table.faces()[f]) {
        if (w == v || s_.distance[w] != 0) continue;
        ++in_plane;
        if (!is_between(w, v) || !divides(v, w)) return false;
      }
      if (in_plane == 2) return false;
    }
    return true;
  }

  std::array<Vec3, 3> corners(Index f, Index v, const Vec3& at) const {
    std::array<Vec3, 3> points;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index w = s_.table.faces()[f][k];
      points[k] = w == v ? at : s_.positions[w];
    }
    return points;
  }

  static Vec3 area_normal(const std::array<Vec3, 3>& p) { return (p[1] - p[0]).cross(p[2] - p[0]); }

  /// The nearest point of the plane to which the vertex can go without changing the volume.
  std::optional<Vec3> target(Index v) const {
    Vec3 normal = Vec3::Zero();  // six times the volume's gradient
    for (const Index f : s_.table.faces_around(v)) normal += area_normal(corners(f, v, s_.positions[v]));
    const Vec3& across = s_.plane.normal;
    const double distance = s_.distance[v], along = normal.dot(across);
    const Vec3 in_plane = normal - along * across;
    if (in_plane.norm() < kFlattest * normal.norm() || normal.isZero(0)) return std::nullopt;
    return s_.positions[v] - distance * across + distance * along / in_plane.squaredNorm() * in_plane;
  }

  bool is_good(Index v, const Vec3& at) const {
    for (const Index f : s_.table.faces_around(v)) {
      const auto before = corners(f, v, s_.positions[v]), after = corners(f, v, at);
      const Vec3 n = area_normal(before), m = area_normal(after);
      if (n.dot(m) < kMostTurned * n.norm() * m.norm()) return false;
      const double skewness = equiangle_skewness(after[0], after[1], after[2]);
      if (skewness > std::max(kWorstMoved, equiangle_skewness(before[0], before[1], before[2]))) return false;
    }
    return true;
  }

  bool snap(Index v) {
    if (!stays_simple(v)) return false;
    const std::optional<Vec3> at = target(v);
    if (!at || !is_good(v, *at)) return false;
    s_.positions[v] = *at;
    s_.distance[v] = 0;
    return true;
  }

  SurfaceAtPlane& s_;
};

}  // namespace

std::vector<Index> snap_to_plane(SurfaceAtPlane& surface, const PlaneLoop& loop) { return Snapper(surface).run(loop); }

}  // namespace vmesh
