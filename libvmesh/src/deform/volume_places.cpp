#include "vmesh/deform/volume_places.h"

#include <algorithm>
#include <limits>
#include <string>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/error.h"
#include "vmesh/core/text.h"

namespace vmesh {
namespace {

/// By how much, relative to the largest coordinate, a point may differ from a vertex that it is: single precision, in
/// which some surfaces are kept, rounds by 6e-8.
constexpr double kSamePoint = 1e-6;

void check_input(const VolumeMesh& mesh, std::span<const Vec3> vertices, std::span<const SurfacePlace> places) {
  if (vertices.size() != places.size())
    throw InvalidInput("binding a volume mesh: " + std::to_string(vertices.size()) + " vertices of the surface and " +
                       std::to_string(places.size()) + " places; give one each");
  for (std::size_t w = 0; w < mesh.wedges.size(); ++w) {
    for (const Index v : mesh.wedges[w]) {
      if (v >= mesh.points.size())
        throw InvalidInput("wedge " + std::to_string(w) + ": there is no point " + std::to_string(v));
    }
  }
  for (const BoundaryFace& face : mesh.boundary) {
    for (const Index v : face.corners) {
      if (v != kNone && v >= mesh.points.size())
        throw InvalidInput("a face of the boundary has point " + std::to_string(v) + ", which does not exist");
    }
  }
}

double same_distance(std::span<const Vec3> vertices) {
  double largest = 0;
  for (const Vec3& p : vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return kSamePoint * largest;
}

/// The nearest vertex within `limit` of `p`, or kNone. Of equally near ones the lowest.
Index vertex_at(const Vec3& p, double limit, std::span<const Vec3> vertices, const BoxTree& boxes) {
  Index nearest = kNone;
  boxes.visit(p, limit, [&](Index v) {
    const double distance = (p - vertices[v]).norm();
    if (distance > limit || (distance == limit && v > nearest)) return;
    limit = distance;
    nearest = v;
  });
  return nearest;
}

/// Which points are joined by the edges of wedges between their triangles.
class Stacks {
 public:
  explicit Stacks(const VolumeMesh& mesh) : offsets_(mesh.points.size() + 1) {
    for_each_edge(mesh, [&](Index a, Index b) { ++offsets_[a + 1], ++offsets_[b + 1]; });
    for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
    neighbours_.resize(offsets_.back());
    std::vector<std::size_t> next(offsets_.begin(), offsets_.end() - 1);
    for_each_edge(mesh, [&](Index a, Index b) { neighbours_[next[a]++] = b, neighbours_[next[b]++] = a; });
  }

  std::span<const Index> neighbours(Index v) const {
    return {neighbours_.data() + offsets_[v], neighbours_.data() + offsets_[v + 1]};
  }

 private:
  template <class Take>
  static void for_each_edge(const VolumeMesh& mesh, const Take& take) {
    for (const Wedge& wedge : mesh.wedges) {
      for (std::size_t i = 0; i < 3; ++i) take(wedge[i], wedge[i + 3]);
    }
  }

  std::vector<std::size_t> offsets_;
  std::vector<Index> neighbours_;
};

/// Gives the places of `known` points to all of their stacks, nearer points first.
void spread(const Stacks& stacks, std::vector<Index> known, std::vector<SurfacePlace>& places) {
  for (std::size_t i = 0; i < known.size(); ++i) {
    for (const Index v : stacks.neighbours(known[i])) {
      if (places[v].segment != kNone) continue;
      places[v] = places[known[i]];
      known.push_back(v);
    }
  }
}

/// Points of stacks without a place that are corners of triangles of the boundary: ends of their stacks.
std::vector<Index> outer_ends(const VolumeMesh& mesh, const Stacks& stacks, const std::vector<SurfacePlace>& places) {
  std::vector<Index> ends;
  for (const BoundaryFace& face : mesh.boundary) {
    if (!face.is_triangle()) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = face.corners[i];
      if (places[v].segment == kNone && !stacks.neighbours(v).empty()) ends.push_back(v);
    }
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

void place_nearest(const Centerline& centerline, const std::vector<Vec3>& points, const std::vector<Index>& which,
                   std::vector<SurfacePlace>& places) {
  std::vector<Vec3> wanted;
  for (const Index v : which) wanted.push_back(points[v]);
  const std::vector<SurfacePlace> nearest = nearest_places(centerline, wanted);
  for (std::size_t i = 0; i < which.size(); ++i) places[which[i]] = nearest[i];
}

std::vector<Index> without_place(const std::vector<SurfacePlace>& places) {
  std::vector<Index> missing;
  for (Index v = 0; v < places.size(); ++v) {
    if (places[v].segment == kNone) missing.push_back(v);
  }
  return missing;
}

/// Distance of `p` from its nearest place in local radii; beyond an end, from the prolonged vessel.
double distance_in_radii(const Centerline& centerline, const SurfacePlace& place, const Vec3& p) {
  if (place.segment >= centerline.segments().size()) {  // isolated nodes
    Index rank = place.segment - static_cast<Index>(centerline.segments().size());
    for (Index n = 0; n < centerline.nodes().size(); ++n) {
      if (centerline.degree(n) == 0 && rank-- == 0)
        return (p - centerline.node(n).position).norm() / centerline.node(n).radius;
    }
    return std::numeric_limits<double>::infinity();
  }
  const auto& [a, b] = centerline.segment(place.segment);
  Vec3 away = p - centerline.point_at(place.segment, place.t);
  const bool beyond = (place.t == 0 && centerline.degree(a) == 1) || (place.t == 1 && centerline.degree(b) == 1);
  if (beyond) {
    const Vec3 axis = (centerline.node(b).position - centerline.node(a).position).normalized();
    away -= away.dot(axis) * axis;
  }
  return away.norm() / centerline.radius_at(place.segment, place.t);
}

void check_is_near(const Centerline& centerline, const VolumeMesh& mesh, double farthest) {
  const std::vector<SurfacePlace> nearest = nearest_places(centerline, mesh.points);
  for (std::size_t v = 0; v < nearest.size(); ++v) {
    const double distance = distance_in_radii(centerline, nearest[v], mesh.points[v]);
    if (distance <= farthest) continue;
    throw InvalidInput(formatted("point %zu at ", v) + point_text(mesh.points[v]) +
                       formatted(" is %.3g local radii away from the nearest vessel, and no point is a vertex of the "
                                 "surface: this is not a mesh around this centerline",
                                 distance));
  }
}

}  // namespace

VolumePlaces volume_places(const Centerline& centerline, const VolumeMesh& mesh, std::span<const Vec3> vertices,
                           std::span<const SurfacePlace> places, double farthest) {
  check_input(mesh, vertices, places);
  VolumePlaces result{std::vector<SurfacePlace>(mesh.points.size()), 0};
  const std::vector<Vec3> corners(vertices.begin(), vertices.end());
  const BoxTree boxes(corners, corners);
  const double limit = same_distance(vertices);
  std::vector<Index> known;
  for (Index v = 0; v < mesh.points.size(); ++v) {
    const Index vertex = vertex_at(mesh.points[v], limit, vertices, boxes);
    if (vertex == kNone) continue;
    result.places[v] = places[vertex];
    known.push_back(v);
  }
  result.shared = known.size();
  if (known.empty()) check_is_near(centerline, mesh, farthest);
  const Stacks stacks(mesh);
  spread(stacks, std::move(known), result.places);
  const std::vector<Index> ends = outer_ends(mesh, stacks, result.places);
  place_nearest(centerline, mesh.points, ends, result.places);
  spread(stacks, ends, result.places);
  place_nearest(centerline, mesh.points, without_place(result.places), result.places);
  return result;
}

}  // namespace vmesh
