#include "fit/buried.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/edit/crossing_guard.h"

namespace vmesh::fitting {
namespace {

// Measured on the hepatic veins 002, seven starts that differ by 1e-3 radii: Hausdorff distance at most 3.5 mm, six of
// them 1.9; up to 8.4 without.
constexpr double kInside = 0.2;         // local radii: how far a face must be from the reference to count,
constexpr double kDeep = 0.5;           // and how far the farthest of a region
constexpr double kAllowedShare = 0.75;  // of its distance: how far what replaces the region may be

constexpr double kReferenceReach = 1.5;  // local radii: how far outward the reference may end for a face to move there
constexpr double kThere = 1e-3;          // local radii: nearer than this is there
constexpr int kMostSteps = 64;           // on the way there; beside a wall they are short

constexpr std::size_t kMostCorners = 512;  // of a mouth: the triangles take their cube

/// Faces joined by edges, without any in common with another.
using Region = std::vector<Index>;

class BuriedWalls {
 public:
  BuriedWalls(FitMesh& surface, const Matches& matches, const FitSetting& setting)
      : surface_(surface), setting_(setting), is_buried_(surface.faces().size(), 0) {
    const std::vector<char> near = near_faces(matches);
    tbb::parallel_for(Index{0}, static_cast<Index>(near.size()),
                      [&](Index f) { is_buried_[f] = !near[f] && is_inside(f); });
    if (std::count(is_buried_.begin(), is_buried_.end(), 1) == 0) return;
    const ClosestPointIndex walls(surface.tri_mesh());
    tbb::parallel_for(Index{0}, static_cast<Index>(near.size()),
                      [&](Index f) { is_buried_[f] = is_buried_[f] && !leaves(f, walls); });
  }

  std::size_t remove() {
    std::size_t count = 0;
    for (const Region& region : regions()) {
      if (farthest(region) > kDeep && replace(region)) ++count;
    }
    return count;
  }

 private:
  ClosestPoint closest(const Vec3& p) const { return setting_.reference.index().closest(p); }

  Vec3 center(const Triangle& face) const {
    return (surface_.position(face[0]) + surface_.position(face[1]) + surface_.position(face[2])) / 3;
  }

  // Whether all points of a face have a counterpart nearby.
  std::vector<char> near_faces(const Matches& matches) const {
    std::vector<char> near(surface_.faces().size(), 1);
    for (std::size_t i = 0; i < matches.from_surface.size(); ++i) {
      const auto f = static_cast<Index>(i / static_cast<std::size_t>(matches.per_face));
      const Match& match = matches.from_surface[i];
      if (match.face == kNone || std::abs(match.distance) > kInside * radius(f)) near[f] = 0;
    }
    return near;
  }

  double radius(Index f) const { return widest_radius(setting_.field, surface_.vertex(surface_.faces()[f][0]).cone); }

  bool is_inside(Index f) const {
    const Vec3 p = center(surface_.faces()[f]);
    const ClosestPoint found = closest(p);
    return found.distance > kInside * radius(f) && setting_.reference.normal(found.face).dot(p - found.point) < 0;
  }

  // Whether the way outward leaves the reference before it meets a wall on the other side: such a face needs only to
  // move. Goes on by the distance to whichever is nearer.
  bool leaves(Index f, const ClosestPointIndex& walls) const {
    const Vec3 from = center(surface_.faces()[f]), outward = surface_.unit_normal(f);
    const auto faces_it = [&](Index g) { return surface_.unit_normal(g).dot(outward) < 0; };
    const double there = kThere * radius(f);
    double way = 0;
    for (int i = 0; i < kMostSteps && way < kReferenceReach * radius(f); ++i) {
      const Vec3 p = from + way * outward;
      const ClosestPoint found = closest(p);
      if (found.distance < there || setting_.reference.normal(found.face).dot(p - found.point) > 0) return true;
      const auto wall = walls.closest_among(p, found.distance, faces_it);
      if (wall && wall->distance < there) return false;
      way += wall ? wall->distance : found.distance;
    }
    return false;
  }

  // From the reference, in local radii.
  double distance(const Triangle& face) const {
    return closest(center(face)).distance / widest_radius(setting_.field, surface_.vertex(face[0]).cone);
  }

  double farthest(const Region& region) const {
    double result = 0;
    for (const Index f : region) result = std::max(result, distance(surface_.faces()[f]));
    return result;
  }

  std::vector<Region> regions() const {
    DisjointSets sets(is_buried_.size());
    for (Index f = 0; f < is_buried_.size(); ++f) {
      if (!is_buried_[f]) continue;
      const Triangle& face = surface_.faces()[f];
      for (std::size_t i = 0; i < 3; ++i) {
        const Index g = surface_.face_of(face[(i + 1) % 3], face[i]);
        if (g != kNone && is_buried_[g]) sets.join(f, g);
      }
    }
    std::map<Index, Region> regions;
    for (Index f = 0; f < is_buried_.size(); ++f) {
      if (is_buried_[f]) regions[sets.find(f)].push_back(f);
    }
    std::vector<Region> result;
    for (auto& [first, region] : regions) result.push_back(std::move(region));
    return result;
  }

  // The edges around the region in the direction of its faces; empty if it is no disc, or open.
  std::vector<Index> mouth_of(const Region& region) const {
    std::map<Index, Index> next;
    std::vector<Index> corners;
    std::size_t sides = 0;
    for (const Index f : region) {
      const Triangle& face = surface_.faces()[f];
      for (std::size_t i = 0; i < 3; ++i) {
        const Index a = face[i], b = face[(i + 1) % 3], g = surface_.face_of(b, a);
        if (on_border(surface_, a)) return {};
        corners.push_back(a);
        if (g != kNone && std::binary_search(region.begin(), region.end(), g)) continue;
        ++sides;
        if (!next.emplace(a, b).second) return {};
      }
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    const std::size_t edges = (3 * region.size() + sides) / 2;
    if (corners.size() + region.size() != edges + 1 || sides < 3 || sides > kMostCorners) return {};
    std::vector<Index> mouth = {next.begin()->first};
    for (Index v = next.begin()->second; v != mouth.front() && mouth.size() <= sides; v = next.at(v))
      mouth.push_back(v);
    return mouth.size() == sides ? mouth : std::vector<Index>{};
  }

  bool replace(const Region& region) {
    const std::vector<Index> mouth = mouth_of(region);
    if (mouth.empty()) return false;
    std::vector<Vec3> corners;
    for (const Index v : mouth) corners.push_back(surface_.position(v));
    FitMesh::Step step{kNone, {}, region, {}};
    const auto may_join = [&](Index i, Index j) {
      for (const auto& [a, b] : {std::pair(mouth[i], mouth[j]), std::pair(mouth[j], mouth[i])}) {
        const Index f = surface_.face_of(a, b);
        if (f != kNone && !std::binary_search(region.begin(), region.end(), f)) return false;
      }
      return true;
    };
    const double allowed = kAllowedShare * farthest(region);
    for (const auto& [i, j, k] : span_polygon(corners, may_join)) {
      step.faces.push_back({mouth[i], mouth[j], mouth[k]});
      if (distance(step.faces.back()) > allowed) return false;
    }
    if (step.faces.empty()) return false;
    FitMesh::Transaction transaction(surface_);
    surface_.take(step);
    if (!crossing_pairs(surface_.positions(), surface_.faces(), transaction.changed_faces()).empty()) return false;
    transaction.keep();
    return true;
  }

  FitMesh& surface_;
  const FitSetting& setting_;
  std::vector<char> is_buried_;  // by face
};

}  // namespace

std::size_t remove_buried_walls(FitMesh& surface, const Matches& matches, const FitSetting& setting) {
  return BuriedWalls(surface, matches, setting).remove();
}

std::vector<Triangle> span_polygon(const std::vector<Vec3>& corners,
                                   const std::function<bool(Index, Index)>& may_join) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t count = corners.size();
  // Of the part between two corners: the least area, and the corner that forms a triangle with them.
  std::vector<double> area(count * count, 0);
  std::vector<Index> apex(count * count, kNone);
  for (std::size_t length = 2; length < count; ++length) {
    for (Index i = 0; i + length < count; ++i) {
      const auto j = static_cast<Index>(i + length);
      double& least = area[i * count + j];
      least = kNever;
      if (length + 1 < count && !may_join(i, j)) continue;
      for (Index k = i + 1; k < j; ++k) {
        const double own = (corners[k] - corners[i]).cross(corners[j] - corners[i]).norm();
        const double sum = own + area[i * count + k] + area[k * count + j];
        if (sum >= least) continue;
        least = sum;
        apex[i * count + j] = k;
      }
    }
  }
  std::vector<Triangle> triangles;
  std::vector<std::pair<Index, Index>> parts = {{Index{0}, static_cast<Index>(count - 1)}};
  if (count < 3 || !std::isfinite(area[count - 1])) return {};
  while (!parts.empty()) {
    const auto [i, j] = parts.back();
    parts.pop_back();
    if (j - i < 2) continue;
    const Index k = apex[i * count + j];
    triangles.push_back({i, k, j});
    parts.emplace_back(i, k);
    parts.emplace_back(k, j);
  }
  return triangles;
}

}  // namespace vmesh::fitting
