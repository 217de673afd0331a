#include "vmesh/surface/flat_reference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "vmesh/surface/defects.h"
#include "vmesh/surface/disc.h"

#include "surface/ends/opening_extension.h"
#include "surface/ends/ring_moves.h"

namespace vmesh {
namespace {

constexpr double kFarthest = 2.5;      // radii along the vessel from an opening to a cap
constexpr double kFarthestBack = 0.5;  // the same backwards: at most this much is cut off
constexpr double kFacing = 0.7;        // cosine between an opening's normal and a cap's
constexpr double kFlat = 0.87;         // cosine between normals of one cap: 30 degrees, as their edges are rounded
constexpr double kSmallest = 0.5, kLargest = 5;  // areas of caps, relative to the opening's: a hemisphere has no cap
constexpr double kShifted = 0.75;                // edges: a nearer opening is moved without an extension

class CapFinder {
 public:
  explicit CapFinder(const TriMesh& mesh) : mesh_(mesh), is_cap_(mesh.faces.size(), 0) {
    std::map<std::pair<Index, Index>, Index> first;
    across_.assign(mesh.faces.size(), {kNone, kNone, kNone});
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      normals_.push_back(area_normal(mesh, f).normalized());
      for (std::size_t i = 0; i < 3; ++i) {
        const auto edge = std::minmax(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]);
        const auto [at, is_new] = first.emplace(edge, f);
        if (is_new) continue;
        across_[f][i] = at->second;
        Triangle& other = across_[at->second];
        *std::find(other.begin(), other.end(), kNone) = f;
      }
    }
  }

  /// The largest flat region across the vessel that begins at the opening.
  std::optional<ReferenceCap> find(const Opening& opening, const Vec3& center, double area) {
    const double radius = std::sqrt(area / std::numbers::pi);
    std::optional<ReferenceCap> best;
    std::vector<Index> best_faces;
    std::vector<char> seen(mesh_.faces.size(), 0);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (seen[f] || is_cap_[f] || !is_near(f, opening.normal, center, radius)) continue;
      const std::vector<Index> faces = flat_part(f, seen);
      const ReferenceCap cap = measure(faces, opening.normal);
      if (cap.area < kSmallest * area || cap.area > kLargest * area || (best && best->area > cap.area)) continue;
      best = cap;
      best_faces = faces;
    }
    for (const Index f : best_faces) is_cap_[f] = 1;
    return best;
  }

  TriMesh without_caps() const {
    TriMesh result{mesh_.vertices, {}};
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!is_cap_[f]) result.faces.push_back(mesh_.faces[f]);
    }
    return result;
  }

 private:
  Vec3 middle(Index f) const {
    const auto& [a, b, c] = mesh_.faces[f];
    return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
  }

  // Faces of an inward-facing reference have the opposite normal.
  bool is_near(Index f, const Vec3& normal, const Vec3& center, double radius) const {
    if (!(std::abs(normals_[f].dot(normal)) > kFacing)) return false;
    const Vec3 offset = middle(f) - center;
    const double along = offset.dot(normal);
    return along > -kFarthestBack * radius && along < kFarthest * radius && (offset - along * normal).norm() < radius;
  }

  std::vector<Index> flat_part(Index start, std::vector<char>& seen) const {
    std::vector<Index> faces = {start};
    seen[start] = 1;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (const Index next : across_[faces[i]]) {
        if (next == kNone || seen[next] || !(normals_[next].dot(normals_[start]) > kFlat)) continue;
        seen[next] = 1;
        faces.push_back(next);
      }
    }
    return faces;
  }

  ReferenceCap measure(const std::vector<Index>& faces, const Vec3& outward) const {
    ReferenceCap cap;
    for (const Index f : faces) {
      const double area = area_normal(mesh_, f).norm() / 2;
      cap.area += area;
      cap.center += area * middle(f);
      cap.normal += area_normal(mesh_, f);
    }
    cap.center /= cap.area;
    cap.normal.normalize();
    if (cap.normal.dot(outward) < 0) cap.normal = -cap.normal;
    return cap;
  }

  const TriMesh& mesh_;
  std::vector<Vec3> normals_;
  std::vector<Triangle> across_;
  std::vector<char> is_cap_;
};

// Rotates the ring perpendicular to the cap's normal, then moves it along that to the cap's plane: by an extension, or
// for a short distance without.
void move_to(GenerateResult& result, Opening& opening, const ReferenceCap& cap) {
  const std::vector<Vec3> ring = ring_positions(result.mesh, opening);
  const double edge = mean_edge(ring), way = (cap.center - area_centroid(ring)).dot(cap.normal);
  const bool by_tube = way > kShifted * edge;
  std::vector<Vec3> ways;
  for (const Vec3& p : ring)
    ways.push_back(((area_centroid(ring) - p).dot(cap.normal) + (by_tube ? 0 : way)) * cap.normal);
  apply_moves(spread_moves(neighbours(result.mesh), vertices_on_rings(result), opening.ring, ways, edge), result.mesh);
  if (by_tube) {
    std::vector<Vec3> target = ring_positions(result.mesh, opening);
    for (Vec3& p : target) p += way * cap.normal;
    extend_opening(result, opening, target);
  }
  opening.center += (cap.center - opening.center).dot(cap.normal) * cap.normal;
  opening.normal = cap.normal;
}

}  // namespace

FlatReference end_at_caps(GenerateResult& result, const TriMesh& reference) {
  if (result.openings.empty()) return {reference, {}};
  FlatReference flat;
  CapFinder finder(reference);
  for (std::size_t i = 0; i < result.openings.size(); ++i) {
    const Opening& opening = result.openings[i];
    const std::vector<Vec3> ring = ring_positions(result.mesh, opening);
    std::optional<ReferenceCap> cap = finder.find(opening, area_centroid(ring), area_vector(ring).norm());
    if (!cap) continue;
    cap->opening = i;
    flat.caps.push_back(*cap);
  }
  flat.mesh = finder.without_caps();
  GenerateResult moved = result;
  for (const ReferenceCap& cap : flat.caps) move_to(moved, moved.openings[cap.opening], cap);
  if (self_intersections(moved.mesh).empty()) {
    result = std::move(moved);
  } else {
    flat.caps.clear();
  }
  return flat;
}

void match_cap_areas(GenerateResult& result, const Centerline& centerline, const std::vector<ReferenceCap>& caps) {
  for (const ReferenceCap& cap : caps) {
    const Opening& opening = result.openings[cap.opening];
    const std::vector<Vec3> ring = ring_positions(result.mesh, opening);
    const Vec3 center = area_centroid(ring);
    const double scale = std::sqrt(cap.area / area_vector(ring).norm());
    for (const Index v : opening.ring) result.mesh.vertices[v] = center + scale * (result.mesh.vertices[v] - center);
  }
  if (!caps.empty()) find_defects_again(centerline, self_intersections(result.mesh), result);
}

}  // namespace vmesh
