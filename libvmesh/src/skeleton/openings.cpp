#include "openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include "vmesh/mesh/polygon_triangulation.h"
#include "vmesh/mesh/topology.h"

#include "ring_shape.h"
#include "wall_probe.h"
#include "wall_shells.h"
#include "wall_text.h"

namespace vmesh::skeleton {
namespace {

// What an end of a vessel is like. Its ring has at least this number of vertices, and is at least this
// round and flat, in radii.
constexpr std::size_t kLeastCorners = 5;
constexpr double kLargestAspect = 4, kLeastCompactness = 0.4, kLargestEndUnevenness = 0.5;
// Its area is at least this share of that of a circle with the perimeter; a jagged cut has .4 and more.
constexpr double kLeastEndRoundness = 0.25;
// Behind an end, the wall is near at this depth; behind a hole that has a tenth of the cross-section of a tube or a
// ball, it is 2.16 radii away. Both in the hole's radii.
constexpr double kDepth = 2, kFarthestWall = 2.1;
// Faces around a hole in the wall are parallel to it, by this mean cosine; one of at most this number of vertices
// is no vessel's end.
constexpr double kFlush = 0.7;
constexpr std::size_t kFewInFlush = 12;
// A ring that is flat within this many radii is triangulated in its plane.
constexpr double kFlatWithin = 0.25;
// Filling takes cubic time in the worst case.
constexpr std::size_t kLongestFilled = 500;

using Edge = std::array<Index, 2>;
using Ring = std::vector<Index>;

/// Boundary loops in the direction in which faces that close them run. Vertices where boundaries meet are left out,
/// with the loops through them; a sound shell has none.
std::vector<Ring> rings_of(const TriMesh& mesh) {
  std::vector<Index> before(mesh.vertices.size(), kNone), degree(mesh.vertices.size(), 0);
  std::vector<Index> order;
  for (const auto& [from, to] : boundary_edges(mesh)) {
    before[to] = from;
    ++degree[from];
    ++degree[to];
    order.push_back(to);
  }
  std::vector<bool> seen(mesh.vertices.size(), false);
  std::vector<Ring> rings;
  for (const Index first : order) {
    Ring ring;
    Index v = first;
    for (; v != kNone && !seen[v] && degree[v] == 2; v = before[v]) {
      seen[v] = true;
      ring.push_back(v);
    }
    if (v == first && ring.size() > 2) rings.push_back(std::move(ring));
  }
  return rings;
}

std::vector<Vec3> positions(const TriMesh& mesh, const Ring& ring) {
  std::vector<Vec3> points;
  for (const Index v : ring) points.push_back(mesh.vertices[v]);
  return points;
}

/// Edges between vertices of the rings, ascending.
std::vector<Edge> edges_among(const TriMesh& mesh, const std::vector<Ring>& rings) {
  std::vector<bool> in_ring(mesh.vertices.size(), false);
  for (const Ring& ring : rings) {
    for (const Index v : ring) in_ring[v] = true;
  }
  std::vector<Edge> edges;
  for (const Triangle& face : mesh.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(face[i], face[(i + 1) % 3]);
      if (in_ring[a] && in_ring[b]) edges.push_back({a, b});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Triangles between the corners of a polygon that is not flat. Empty if there are none.
std::vector<Triangle> fill_uneven(const std::vector<Vec3>& ring) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Triangle> faces;
  if (ring.size() > kLongestFilled) return faces;
  std::vector<Point> points;
  for (const Vec3& p : ring) points.emplace_back(p.x(), p.y(), p.z());
  struct Corners {
    Triangle corners;
    Corners(int a, int b, int c) : corners{static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c)} {}
  };
  std::vector<Corners> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(found));
  for (const Corners& face : found) faces.push_back(face.corners);
  return faces;
}

/// Whether the faces close a polygon of `count` corners without an edge that the mesh has already.
bool fit(const std::vector<Triangle>& faces, const Ring& ring, const std::vector<Edge>& taken) {
  if (faces.size() + 2 != ring.size()) return false;
  for (const Triangle& face : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(face[i], face[(i + 1) % 3]);
      if (a + 1 == b || (a == 0 && b + 1 == ring.size())) continue;
      const auto [low, high] = std::minmax(ring[a], ring[b]);
      if (std::binary_search(taken.begin(), taken.end(), Edge{low, high})) return false;
    }
  }
  return true;
}

/// The normals of the faces at boundary edges, by the vertex that the edge runs to in its face.
std::vector<Vec3> normals_at_boundary(const TriMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  const Mates mates = mates_of(mesh);
  for (Index side = 0; side < mates.size(); ++side) {
    if (mates[side] == kNone) normals[mesh.faces[side / 3][(side + 1) % 3]] = area_normal(mesh, side / 3).normalized();
  }
  return normals;
}

double flushness_of(const TriMesh& mesh, const Ring& ring, const RingShape& shape, const std::vector<Vec3>& normals) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double length = (mesh.vertices[ring[(i + 1) % ring.size()]] - mesh.vertices[ring[i]]).norm();
    sum += length * std::abs(normals[ring[i]].dot(shape.normal));
  }
  return shape.perimeter > 0 ? sum / shape.perimeter : 0;
}

/// Appends faces that close the ring.
void fill(TriMesh& mesh, const Ring& ring, const RingShape& shape, const std::vector<Edge>& taken) {
  const std::vector<Vec3> points = positions(mesh, ring);
  const bool is_flat = ring.size() == 3 || (shape.area > 0 && shape.unevenness <= kFlatWithin * shape.radius);
  std::vector<Triangle> faces = is_flat ? triangulate_polygon(points) : fill_uneven(points);
  if (fit(faces, ring, taken)) {
    for (const auto& [a, b, c] : faces) mesh.faces.push_back({ring[a], ring[b], ring[c]});
    return;
  }
  const auto middle = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back(shape.center);
  for (std::size_t i = 0; i < ring.size(); ++i) mesh.faces.push_back({ring[i], ring[(i + 1) % ring.size()], middle});
}

enum class Kind { end, hole, uneven };

/// `flushness`: mean cosine between the ring's normal and those of the faces around it.
Kind kind_of(std::size_t corners, const RingShape& shape, double flushness, const WallProbe& wall) {
  if (corners < kLeastCorners || !(shape.compactness >= kLeastCompactness) || shape.aspect > kLargestAspect)
    return Kind::hole;
  if (4 * std::numbers::pi * shape.area < kLeastEndRoundness * shape.perimeter * shape.perimeter) return Kind::hole;
  if (flushness > kFlush && corners < kFewInFlush) return Kind::hole;
  const Vec3 behind = shape.center - kDepth * shape.radius * shape.normal;
  if (wall.nearest(behind).distance > kFarthestWall * shape.radius) return Kind::hole;
  return shape.unevenness > kLargestEndUnevenness * shape.radius ? Kind::uneven : Kind::end;
}

void note(OpeningsClosed& closed, Kind kind, const RingShape& shape) {
  if (kind == Kind::end) {
    closed.smallest_end = closed.ends == 0 ? shape.area : std::min(closed.smallest_end, shape.area);
    closed.largest_end = std::max(closed.largest_end, shape.area);
    ++closed.ends;
  } else if (kind == Kind::hole) {
    if (closed.holes++ > 0 && closed.largest_hole >= shape.area) return;
    closed.largest_hole = shape.area;
    closed.hole_at = shape.center;
  } else if (closed.uneven++ == 0) {
    closed.uneven_at = shape.center;
  }
}

/// The shell's mesh is `mesh` with all rings closed. Where the faces that close each ring begin, and the last end.
std::vector<std::size_t> fill_all(Shell& shell, const TriMesh& mesh, const std::vector<Ring>& rings) {
  TriMesh& full = shell.part.mesh = mesh;
  std::vector<std::size_t> begin;
  const std::vector<Edge> taken = edges_among(mesh, rings);
  for (const Ring& ring : rings) {
    begin.push_back(full.faces.size());
    const RingShape shape = shape_of(positions(mesh, ring));
    shell.largest_opening = std::max(shell.largest_opening, shape.area);
    fill(full, ring, shape, taken);
  }
  begin.push_back(full.faces.size());
  shell.part.end_of_face.assign(full.faces.size(), kNone);
  shell.part.is_filling.assign(mesh.faces.size(), false);
  shell.part.is_filling.resize(full.faces.size(), true);
  return begin;
}

/// Notes what was closed and remembers what are ends.
class EndFinder {
 public:
  EndFinder(const TriMesh& mesh, Shell& shell, OpeningsClosed& closed)
      : mesh_(mesh), wall_(mesh), normals_(normals_at_boundary(mesh)), shell_(shell), closed_(closed) {}

  const WallProbe& wall() const { return wall_; }

  /// `ring`: was closed by the faces from `begin` to `end`. `turned`: it is clockwise seen from outside.
  void take(const Ring& ring, bool turned, std::size_t begin, std::size_t end) {
    std::vector<Vec3> points = positions(mesh_, ring);
    if (turned) std::reverse(points.begin(), points.end());
    const RingShape shape = shape_of(points);
    const Kind kind = kind_of(ring.size(), shape, flushness_of(mesh_, ring, shape, normals_), wall_);
    note(closed_, kind, shape);
    if (kind != Kind::end) return;
    for (std::size_t f = begin; f < end; ++f) shell_.part.end_of_face[f] = static_cast<Index>(shell_.ends.size());
    shell_.ends.push_back({shape.center, shape.normal, shape.area, std::move(points), true, 0});
  }

 private:
  const TriMesh& mesh_;
  WallProbe wall_;
  std::vector<Vec3> normals_;
  Shell& shell_;
  OpeningsClosed& closed_;
};

}  // namespace

std::vector<std::string> OpeningsClosed::notes() const {
  std::vector<std::string> lines;
  if (ends > 0) {
    const std::string sizes =
        ends == 1 ? text(largest_end) : "areas of " + text(smallest_end) + " to " + text(largest_end);
    lines.push_back(counted(ends, "opening is closed and taken for a flat end of a vessel, ",
                            "openings are closed and taken for flat ends of vessels, ") +
                    sizes + " mm^2");
  }
  if (holes > 0) {
    lines.push_back(counted(holes, "hole in the wall is closed, ", "holes in the wall are closed, the largest ") +
                    text(largest_hole) + " mm^2 at " + text(hole_at));
  }
  if (uneven > 0) {
    lines.push_back(counted(uneven, "opening that is far from flat is closed, at ",
                            "openings that are far from flat are closed, the first at ") +
                    text(uneven_at));
  }
  return lines;
}

Shell closed_shell(TriMesh mesh, OpeningsClosed& closed) {
  Shell shell;
  const std::vector<Ring> rings = rings_of(mesh);
  const std::vector<std::size_t> begin = fill_all(shell, mesh, rings);
  shell.part.volume = enclosed_volume(shell.part.mesh);
  shell.was_inward = shell.part.volume < 0;
  if (shell.was_inward) {
    shell.part.volume = -shell.part.volume;
    for (Triangle& face : shell.part.mesh.faces) std::swap(face[1], face[2]);
  }
  if (rings.empty()) return shell;
  EndFinder ends(mesh, shell, closed);
  for (std::size_t r = 0; r < rings.size(); ++r) ends.take(rings[r], shell.was_inward, begin[r], begin[r + 1]);
  return shell;
}

Shell closed_soup(TriMesh mesh, OpeningsClosed& closed) {
  Shell shell;
  const std::vector<Ring> rings = rings_of(mesh);
  const std::vector<std::size_t> begin = fill_all(shell, mesh, rings);
  EndFinder ends(mesh, shell, closed);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    const RingShape shape = shape_of(positions(mesh, rings[r]));
    const Vec3 way = kDepth * shape.radius * shape.normal;
    // The wall of a tube is nearer behind its end than before it.
    const auto distance = [&](const Vec3& p) { return ends.wall().nearest(p).distance; };
    ends.take(rings[r], distance(shape.center + way) < distance(shape.center - way), begin[r], begin[r + 1]);
  }
  return shell;
}

}  // namespace vmesh::skeleton
