#include "surface/ends/extension_room.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmesh/surface/disc.h"

namespace vmesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSideways = 1.05;  // the cylinder that has to be free, in radii of the ring
constexpr double kAhead = 0.25;     // the gap at its end, likewise

struct HeightRange {
  double low = kInfinity, high = -kInfinity;

  void add(double height) {
    low = std::min(low, height);
    high = std::max(high, height);
  }
};

/// Adds the heights (z) of the part of an edge that is within `radius` of the z axis.
void add_edge(const Vec3& a, const Vec3& b, double radius, HeightRange& heights) {
  const Eigen::Vector2d start = a.head<2>(), way = (b - a).head<2>();
  const double square = way.squaredNorm(), half = start.dot(way), rest = start.squaredNorm() - radius * radius;
  double from = 0, to = 1;
  if (square > 0) {
    const double root = half * half - square * rest;
    if (root < 0) return;
    from = std::max(from, (-half - std::sqrt(root)) / square);
    to = std::min(to, (-half + std::sqrt(root)) / square);
  } else if (rest > 0) {
    return;
  }
  if (from > to) return;
  for (const double t : {from, to}) heights.add(a.z() + t * (b.z() - a.z()));
}

bool is_inside(const std::array<Vec3, 3>& corners, const Eigen::Vector2d& p) {
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector2d a = corners[i].head<2>(), edge = (corners[(i + 1) % 3] - corners[i]).head<2>();
    const double side = edge.x() * (p - a).y() - edge.y() * (p - a).x();
    left += side >= 0;
    right += side <= 0;
  }
  return left == 3 || right == 3;
}

/// The heights of a triangle within `radius` of the z axis: they are least and greatest on its edges, or on the circle.
HeightRange heights_within(const std::array<Vec3, 3>& corners, double radius) {
  HeightRange heights;
  for (std::size_t i = 0; i < 3; ++i) add_edge(corners[i], corners[(i + 1) % 3], radius, heights);
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (normal.z() == 0) return heights;
  const Eigen::Vector2d slope = -normal.head<2>() / normal.z();
  for (const double side : {-radius, radius}) {
    const Eigen::Vector2d p = side * slope.normalized();
    if (is_inside(corners, p)) heights.add(corners[0].z() + slope.dot(p - corners[0].head<2>()));
  }
  return heights;
}

std::array<Vec3, 3> corners_of(const TriMesh& mesh, const Triangle& face) {
  return {mesh.vertices[face[0]], mesh.vertices[face[1]], mesh.vertices[face[2]]};
}

/// The free way along a cylinder.
struct FreeWay {
  FreeWay(const std::vector<Vec3>& ring, double limit) : start(area_centroid(ring)), end_height(limit) {
    const Vec3 normal = area_vector(ring).normalized(), side = normal.unitOrthogonal();
    axes.row(0) = side;
    axes.row(1) = normal.cross(side);
    axes.row(2) = normal;
    for (const Vec3& p : ring) ring_radius = std::max(ring_radius, (axes * (p - start)).head<2>().norm());
    end_height += kAhead * ring_radius;
  }

  /// Ends it at the triangle, if that is in the way.
  void meet(const std::array<Vec3, 3>& corners, const Triangle& vertices) {
    std::array<Vec3, 3> placed;
    for (std::size_t i = 0; i < 3; ++i) placed[i] = axes * (corners[i] - start);
    const HeightRange heights = heights_within(placed, kSideways * ring_radius);
    if (!(heights.high > 0) || std::max(heights.low, 0.0) >= end_height) return;
    end_height = std::max(heights.low, 0.0);
    obstacle = vertices;
  }

  Vec3 start;
  Eigen::Matrix3d axes;  // the third along the way
  double ring_radius = 0;
  double end_height;
  Triangle obstacle = {kNone, kNone, kNone};
};

}  // namespace

ExtensionRoom::ExtensionRoom(const GenerateResult& result) : closed_(with_lids(result)) {
  tree_ = BoxTree(static_cast<Index>(closed_.faces.size()), [this](Index f) {
    const auto [a, b, c] = corners_of(closed_, closed_.faces[f]);
    return BoxTree::Box{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  });
}

ExtensionRoom::Room ExtensionRoom::ahead(const Opening& opening, const std::vector<Vec3>& ring, double limit) const {
  FreeWay way(ring, limit);
  const Vec3 end = way.start + way.end_height * way.axes.row(2).transpose();
  const Vec3 margin = Vec3::Constant(kSideways * way.ring_radius);
  const Vec3 low = way.start.cwiseMin(end) - margin, high = way.start.cwiseMax(end) + margin;
  const auto is_at_ring = [&](Index v) {
    return std::find(opening.ring.begin(), opening.ring.end(), v) != opening.ring.end();
  };
  tree_.visit_overlapping(low, high, [&](Index f) {
    const Triangle& face = closed_.faces[f];
    if (std::none_of(face.begin(), face.end(), is_at_ring)) way.meet(corners_of(closed_, face), face);
  });
  for (const Extension& extension : extensions_) {
    if (!BoxTree::Box{low, high}.overlaps(extension.low, extension.high)) continue;
    for (const Obstacle& face : extension.faces) way.meet(face.corners, face.vertices);
  }
  if (way.obstacle[0] == kNone) return {limit, kNone, Vec3::Zero()};
  // The centre of a lid, which is no vertex of the surface, has the greatest number.
  const Index vertex = *std::min_element(way.obstacle.begin(), way.obstacle.end());
  return {std::max(0.0, way.end_height - kAhead * way.ring_radius), vertex,
          way.start + way.end_height * way.axes.row(2).transpose()};
}

ExtensionRoom::Extension::Extension() : low(Vec3::Constant(kInfinity)), high(Vec3::Constant(-kInfinity)) {}

void ExtensionRoom::Extension::add(const std::array<Vec3, 3>& corners, const Triangle& vertices) {
  faces.push_back({corners, vertices});
  for (const Vec3& p : corners) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
}

void ExtensionRoom::add(const TriMesh& mesh, std::size_t first_face, const std::vector<Index>& ring) {
  Extension extension;
  for (std::size_t f = first_face; f < mesh.faces.size(); ++f)
    extension.add(corners_of(mesh, mesh.faces[f]), mesh.faces[f]);
  Vec3 center = Vec3::Zero();
  for (const Index v : ring) center += mesh.vertices[v] / static_cast<double>(ring.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Index a = ring[i], b = ring[(i + 1) % ring.size()];
    extension.add({mesh.vertices[a], mesh.vertices[b], center}, {a, b, b});
  }
  extensions_.push_back(std::move(extension));
}

}  // namespace vmesh
