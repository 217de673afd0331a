#include "vmesh/volume/crossing.h"

#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/MP_Float.h>

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point to_point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// Ties are broken as if the whole polyline were moved by (e, e^2, e^3), e > 0 infinitely small. The moved polyline
// meets no edge and no vertex, so its outward and inward crossings of a closed mesh agree with which of its ends are
// inside. Where a determinant vanishes, the sign of its change under the move decides: that of the first non-zero
// component of a vector.

bool in_front(const Point triangle[3], const Point& p) {
  const Point &a = triangle[0], &b = triangle[1], &c = triangle[2];
  auto sign = CGAL::orientation(a, b, c, p);
  for (int i = 0; i < 3 && sign == CGAL::ZERO; ++i) {  // the triangle's normal
    const auto flat = [i](const Point& v) { return Kernel::Point_2(v[(i + 1) % 3], v[(i + 2) % 3]); };
    sign = CGAL::orientation(flat(a), flat(b), flat(c));
  }
  return sign == CGAL::POSITIVE;
}

// Side on which the line pq passes the edge uv: the sign of (q - p) x (u - p) . (v - p); its change is the sign of
// (q - p) x (v - u). Zero only for an edge along the line, of a triangle that pq does not cross.
CGAL::Sign side_of_edge(const Point& p, const Point& q, const Point& u, const Point& v) {
  auto sign = CGAL::orientation(p, q, u, v);
  for (int i = 0; i < 3 && sign == CGAL::ZERO; ++i) {
    using Exact = CGAL::MP_Float;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sign = CGAL::sign((Exact(q[j]) - Exact(p[j])) * (Exact(v[k]) - Exact(u[k])) -
                      (Exact(q[k]) - Exact(p[k])) * (Exact(v[j]) - Exact(u[j])));
  }
  return sign;
}

}  // namespace

std::optional<Crossing> find_crossing(const Vec3& first, const Vec3& last, const TriangleCorners& triangle) {
  const Point p = to_point(first), q = to_point(last);
  const Point corner[3] = {to_point(triangle[0]), to_point(triangle[1]), to_point(triangle[2])};
  const bool first_in_front = in_front(corner, p);
  if (first_in_front == in_front(corner, q)) return std::nullopt;
  const auto side = side_of_edge(p, q, corner[0], corner[1]);
  if (side_of_edge(p, q, corner[1], corner[2]) != side) return std::nullopt;
  if (side_of_edge(p, q, corner[2], corner[0]) != side) return std::nullopt;
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double before = normal.dot(first - triangle[0]), after = normal.dot(last - triangle[0]);
  const double span = before - after;
  const double t = span != 0 ? std::clamp(before / span, 0.0, 1.0) : 0.5;
  return Crossing{t, first_in_front ? -1 : 1};
}

}  // namespace vmesh
