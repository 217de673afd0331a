#include "vmesh/mesh/face_pair.h"

#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "vmesh/mesh/face_plane.h"

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// Corners are numbered 0 to 2 within their faces.
Point point(const PlacedFace& f, int i) { return {f.points[i].x(), f.points[i].y(), f.points[i].z()}; }
Kernel::Triangle_3 triangle(const PlacedFace& f) { return {point(f, 0), point(f, 1), point(f, 2)}; }

bool has(const PlacedFace& f, Index v) { return f.vertices[0] == v || f.vertices[1] == v || f.vertices[2] == v; }

int apex(const PlacedFace& f, const PlacedFace& other) {
  for (int i = 0; i < 3; ++i) {
    if (!has(other, f.vertices[i])) return i;
  }
  return 0;
}

// Two faces at an edge overlap only when they are coplanar and lie on the same side of it.
bool folded(const PlacedFace& x, const PlacedFace& y) {
  const int i = apex(x, y), j = apex(y, x);
  const Point a = point(x, (i + 1) % 3), b = point(x, (i + 2) % 3), c = point(x, i), d = point(y, j);
  return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

bool opposite_edge_meets(const PlacedFace& x, const PlacedFace& y, int common) {
  return CGAL::do_intersect(triangle(y), Kernel::Segment_3(point(x, (common + 1) % 3), point(x, (common + 2) % 3)));
}

}  // namespace

bool intersect(const PlacedFace& x, const PlacedFace& y) {
  int count = 0, in_x = 0, in_y = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (x.vertices[i] != y.vertices[j]) continue;
      ++count;
      in_x = i;
      in_y = j;
    }
  }
  if (count == 3) return true;
  if (FacePlane(x).has_on_one_side(y) || (count < 2 && FacePlane(y).has_on_one_side(x))) return false;
  if (count == 2) return folded(x, y);
  if (count == 1) return opposite_edge_meets(x, y, in_x) || opposite_edge_meets(y, x, in_y);
  return CGAL::do_intersect(triangle(x), triangle(y));
}

bool meets_segment(const PlacedFace& x, const Vec3& from, const Vec3& to) {
  const Kernel::Segment_3 segment({from.x(), from.y(), from.z()}, {to.x(), to.y(), to.z()});
  return CGAL::do_intersect(triangle(x), segment);
}

bool is_degenerate(const PlacedFace& x) { return CGAL::collinear(point(x, 0), point(x, 1), point(x, 2)); }

}  // namespace vmesh
