#include "surface/cut/plane_loop.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace vmesh {
namespace {

bool is_behind(double distance) { return distance < 0; }

/// The edge of a face that leads from behind the plane to before it; none if it is not cut.
std::optional<MeshEdge> edge_through(const Triangle& face, const std::vector<double>& distance) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Index u = face[k], v = face[(k + 1) % 3];
    if (is_behind(distance[u]) && !is_behind(distance[v])) return MeshEdge{u, v};
  }
  return std::nullopt;
}

/// From face to face until the first comes again, or a border.
struct Trace {
  PlaneLoop loop;
  bool closed = false;
};
Trace trace_from(Index first, const FaceTable& table, const std::vector<double>& distance, std::vector<char>& seen) {
  Trace trace;
  for (Index f = first; f != kNone && !seen[f];) {
    const std::optional<MeshEdge> edge = edge_through(table.faces()[f], distance);
    if (!edge) break;
    seen[f] = 1;
    trace.loop.faces.push_back(f);
    trace.loop.edges.push_back(*edge);
    f = table.face_of(edge->b, edge->a);
    trace.closed = f == first;
  }
  return trace;
}

/// How often a closed polygon turns around the plane's point, and its area (mm^2).
struct Enclosure {
  long turns = 0;
  double area = 0;
};
Enclosure enclosure_of(const PlaneLoop& loop, const std::vector<Vec3>& positions, const CutPlane& plane,
                       const std::vector<double>& distance) {
  std::vector<Vec3> arms;
  for (const auto& [u, v] : loop.edges) {
    const double share = share_at_plane(distance[u], distance[v]);
    arms.push_back((1 - share) * positions[u] + share * positions[v] - plane.point);
  }
  double angle = 0, twice_area = 0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const Vec3 &p = arms[i], &q = arms[(i + 1) % arms.size()];
    const double across = p.cross(q).dot(plane.normal);
    angle += std::atan2(across, p.dot(q));
    twice_area += across;
  }
  return {std::lround(angle / (2 * std::numbers::pi)), std::abs(twice_area) / 2};
}

}  // namespace

std::optional<PlaneLoop> loop_around(const std::vector<Vec3>& positions, const FaceTable& table, const CutPlane& plane,
                                     const std::vector<double>& distance) {
  std::vector<char> seen(table.faces().size(), 0);
  std::optional<PlaneLoop> innermost;
  double least = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < table.faces().size(); ++f) {
    if (seen[f] || !table.has_face(f)) continue;
    Trace trace = trace_from(f, table, distance, seen);
    if (!trace.closed) continue;
    const Enclosure enclosure = enclosure_of(trace.loop, positions, plane, distance);
    if (std::abs(enclosure.turns) != 1 || enclosure.area >= least) continue;
    least = enclosure.area;
    innermost = std::move(trace.loop);
  }
  return innermost;
}

}  // namespace vmesh
