#include <algorithm>
#include <atomic>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

#include "mesh/blocks.h"
#include "mesh/vertex_corners.h"

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// What keeps the edges at some vertices from having one face on either side.
struct Gaps {
  bool repeated = false, open = false;

  void operator|=(const Gaps& other) {
    repeated |= other.repeated;
    open |= other.open;
  }
};

// `sides`: at a vertex, those of an edge adjacent. In a closed surface a face runs along every edge, and one back.
Gaps gaps_at(Index vertex, const std::vector<SideAt>& sides) {
  Gaps gaps;
  for (std::size_t i = 0, next; i < sides.size(); i = next) {
    int outwards = 0, back = 0;
    for (next = i; next < sides.size() && sides[next].other == sides[i].other; ++next)
      ++(sides[next].outwards ? outwards : back);
    if (sides[i].other == vertex) back = outwards;  // listed once, leads both ways
    gaps.repeated |= outwards > 1 || back > 1;
    gaps.open |= outwards == 0 || back == 0;
  }
  return gaps;
}

// Throws unless every edge has one face on either side.
void check_closed(const TriMesh& mesh) {
  const VertexCorners corners(mesh);
  Gaps all;
  for (const Gaps& some : of_blocks<Gaps>(mesh.vertices.size(), [&](std::size_t begin, std::size_t end) {
         Gaps gaps;
         std::vector<SideAt> sides;
         for (auto v = static_cast<Index>(begin); v < end; ++v) {
           list_sides(mesh, corners, v, sides);
           gaps |= gaps_at(v, sides);
         }
         return gaps;
       }))
    all |= some;
  if (all.repeated) throw InvalidInput("inside is not defined: the mesh is not manifold");
  if (all.open || mesh.faces.empty()) throw InvalidInput("inside is not defined: the mesh is open");
}

// Points in the cells of a grid perpendicular to x: there are few points and many faces.
class PointGrid {
 public:
  explicit PointGrid(const std::vector<Vec3>& points)
      : side_(static_cast<int>(std::clamp(std::sqrt(static_cast<double>(points.size())), 1.0, kMostCells))) {
    if (points.empty()) return;
    low_ = high_ = points.front();
    for (const Vec3& p : points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    first_.assign(cell_of(side_, 0) + 1, 0);
    for (const Vec3& p : points) ++first_[cell_of(row(p, 1), row(p, 2)) + 1];
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    points_.resize(points.size());
    for (Index i = 0; i < points.size(); ++i) points_[next[cell_of(row(points[i], 1), row(points[i], 2))]++] = i;
  }

  /// Calls visit(point) for points whose lines along x may meet the box.
  template <class Visit>
  void visit(const Vec3& low, const Vec3& high, Visit&& visit) const {
    if (points_.empty() || (low.tail<2>().array() > high_.tail<2>().array()).any() ||
        (high.tail<2>().array() < low_.tail<2>().array()).any())
      return;
    for (int y = row(low, 1); y <= row(high, 1); ++y) {
      const std::size_t end = first_[cell_of(y, row(high, 2)) + 1];  // the cells of a row are contiguous
      for (std::size_t i = first_[cell_of(y, row(low, 2))]; i < end; ++i) visit(points_[i]);
    }
  }

 private:
  static constexpr double kMostCells = 1024;  // in a row

  int row(const Vec3& p, int axis) const {
    const double size = high_[axis] - low_[axis];
    return size > 0 ? static_cast<int>(std::clamp(side_ * ((p[axis] - low_[axis]) / size), 0.0, side_ - 1.0)) : 0;
  }
  std::size_t cell_of(int y, int z) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(z);
  }

  int side_;  // cells in a row
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  std::vector<Index> first_;  // of every cell in points_; one more for the end
  std::vector<Index> points_;
};

// Whether a ray along x meets a face, with exact predicates: as if its origin were moved by (0, e, e^2), e > 0
// infinitely small, so that it meets no edge.
class RayTest {
 public:
  explicit RayTest(const TriMesh& mesh) : mesh_(mesh), beyond_(mesh.vertices[mesh.faces.front()[0]].x()) {
    double low = beyond_;
    for (const Triangle& face : mesh.faces) {
      for (const Index v : face) {
        low = std::min(low, mesh.vertices[v].x());
        beyond_ = std::max(beyond_, mesh.vertices[v].x());
      }
    }
    beyond_ += beyond_ - low;
  }

  bool meets(const Triangle& face, const Vec3& p) const { return is_across(face, p) && is_before(face, p); }

  bool is_on(const Triangle& face, const Vec3& p) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double a = mesh_.vertices[face[0]][axis], b = mesh_.vertices[face[1]][axis],
                   c = mesh_.vertices[face[2]][axis];
      if (p[axis] < std::min({a, b, c}) || p[axis] > std::max({a, b, c})) return false;
    }
    const Kernel::Point_3 q(p.x(), p.y(), p.z());
    const Kernel::Triangle_3 triangle(point(face[0]), point(face[1]), point(face[2]));
    return CGAL::coplanar(triangle[0], triangle[1], triangle[2], q) && (triangle.is_degenerate() || triangle.has_on(q));
  }

 private:
  Kernel::Point_3 point(Index v) const {
    const Vec3& p = mesh_.vertices[v];
    return {p.x(), p.y(), p.z()};
  }

  // Whether the line through the point meets the face: it passes an odd number of the face's edges in y.
  bool is_across(const Triangle& face, const Vec3& p) const {
    bool across = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [u, v] = std::minmax(face[i], face[(i + 1) % 3]);
      const Vec3 *low = &mesh_.vertices[u], *high = &mesh_.vertices[v];
      if ((low->z() > p.z()) == (high->z() > p.z())) continue;
      if (low->z() > high->z()) std::swap(low, high);
      across ^= CGAL::orientation(Kernel::Point_2(low->y(), low->z()), Kernel::Point_2(high->y(), high->z()),
                                  Kernel::Point_2(p.y(), p.z())) == CGAL::LEFT_TURN;
    }
    return across;
  }

  // Whether a face met by the line through the point is on the side of larger x.
  bool is_before(const Triangle& face, const Vec3& p) const {
    const double a = mesh_.vertices[face[0]].x(), b = mesh_.vertices[face[1]].x(), c = mesh_.vertices[face[2]].x();
    if (p.x() < std::min({a, b, c})) return true;
    if (p.x() > std::max({a, b, c})) return false;
    const Kernel::Point_3 q(p.x(), p.y(), p.z()), beyond(beyond_, p.y(), p.z());
    const auto side = CGAL::orientation(point(face[0]), point(face[1]), point(face[2]), q);
    return side != CGAL::orientation(point(face[0]), point(face[1]), point(face[2]), beyond);
  }

  const TriMesh& mesh_;
  double beyond_;  // an x beyond all faces
};

}  // namespace

std::vector<bool> points_inside(const TriMesh& mesh, const std::vector<Vec3>& points) {
  check_closed(mesh);
  const PointGrid grid(points);
  const RayTest ray(mesh);
  constexpr unsigned char kInside = 1, kOn = 2;
  std::vector<std::atomic<unsigned char>> found(points.size());  // the order in which faces are found does not matter
  for_blocks(mesh.faces.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& face = mesh.faces[f];
      const Vec3 &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
      grid.visit(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), [&](Index i) {
        if (ray.is_on(face, points[i])) found[i].fetch_or(kOn, std::memory_order_relaxed);
        if (ray.meets(face, points[i])) found[i].fetch_xor(kInside, std::memory_order_relaxed);
      });
    }
  });
  std::vector<bool> inside(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) inside[i] = found[i].load() == kInside;
  return inside;
}

}  // namespace vmesh
