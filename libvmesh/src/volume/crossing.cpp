#include "vmesh/volume/crossing.h"

#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point to_point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

bool in_front(const Point triangle[3], const Point& p) {
  return CGAL::orientation(triangle[0], triangle[1], triangle[2], p) != CGAL::NEGATIVE;
}

// Side on which the line pq passes the edge from corner i to corner i + 1. Evaluated in the order of the corners'
// indices, so that both faces of an edge agree; a line that meets the edge passes it on the positive side.
int side_of_edge(const Point& p, const Point& q, const Point corner[3], const Index index[3], int i) {
  const int j = (i + 1) % 3;
  const bool forward = index[i] < index[j];
  const auto sign =
      forward ? CGAL::orientation(p, q, corner[i], corner[j]) : CGAL::orientation(p, q, corner[j], corner[i]);
  const int canonical = sign == CGAL::NEGATIVE ? -1 : 1;
  return forward ? canonical : -canonical;
}

}  // namespace

std::optional<Crossing> find_crossing(const Vec3& first, const Vec3& last, const IndexedTriangle& triangle) {
  const Point p = to_point(first), q = to_point(last);
  const Point corner[3] = {to_point(triangle.corner[0]), to_point(triangle.corner[1]), to_point(triangle.corner[2])};
  const bool first_in_front = in_front(corner, p);
  if (first_in_front == in_front(corner, q)) return std::nullopt;
  const int side = side_of_edge(p, q, corner, triangle.index, 0);
  if (side_of_edge(p, q, corner, triangle.index, 1) != side) return std::nullopt;
  if (side_of_edge(p, q, corner, triangle.index, 2) != side) return std::nullopt;
  const Vec3 normal = (triangle.corner[1] - triangle.corner[0]).cross(triangle.corner[2] - triangle.corner[0]);
  const double before = normal.dot(first - triangle.corner[0]), after = normal.dot(last - triangle.corner[0]);
  const double span = before - after;
  const double t = span != 0 ? std::clamp(before / span, 0.0, 1.0) : 0.5;
  return Crossing{t, first_in_front ? -1 : 1};
}

}  // namespace vmesh
