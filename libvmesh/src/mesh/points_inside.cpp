#include <algorithm>
#include <cmath>
#include <span>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Throws unless every edge has one face on either side.
void check_closed(const TriMesh& mesh) {
  const auto visit_ways = [&](auto&& visit) {
    for (const Triangle& face : mesh.faces) {
      for (std::size_t i = 0; i < 3; ++i) visit(face[i], face[(i + 1) % 3]);
    }
  };
  std::vector<std::size_t> end(mesh.vertices.size() + 1, 0);  // of the ends of a vertex's ways
  visit_ways([&](Index from, Index) { ++end[from + 1]; });
  for (std::size_t v = 0; v + 1 < end.size(); ++v) end[v + 1] += end[v];
  std::vector<Index> to(end.back());
  visit_ways([&](Index from, Index last) { to[end[from]++] = last; });
  const auto ways = [&](Index v) { return std::span(to.data() + (v > 0 ? end[v - 1] : 0), to.data() + end[v]); };
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    const auto ends = ways(v);
    std::sort(ends.begin(), ends.end());
    if (std::adjacent_find(ends.begin(), ends.end()) != ends.end())
      throw InvalidInput("inside is not defined: the mesh is not manifold");
  }
  bool closed = !mesh.faces.empty();
  visit_ways([&](Index from, Index last) {
    const auto back = ways(last);
    closed = closed && std::binary_search(back.begin(), back.end(), from);
  });
  if (!closed) throw InvalidInput("inside is not defined: the mesh is open");
}

// Counts the faces that a ray along x meets, with exact predicates: as if its origin were moved by (0, e, e^2), e > 0
// infinitely small, so that it meets no edge. Faces are found in a grid across x.
class RayCaster {
 public:
  explicit RayCaster(const TriMesh& mesh) : mesh_(mesh) {
    low_ = high_ = mesh.vertices[mesh.faces.front()[0]];
    for (const Triangle& face : mesh.faces) {
      for (const Index v : face) {
        low_ = low_.cwiseMin(mesh.vertices[v]);
        high_ = high_.cwiseMax(mesh.vertices[v]);
      }
    }
    side_ = static_cast<int>(std::clamp(std::sqrt(static_cast<double>(mesh.faces.size())), 1.0, kMostCells));
    while (side_ > 1 && entries() > kMostEntries * mesh.faces.size()) side_ /= 2;
    fill();
  }

  bool is_inside(const Vec3& p) const {
    if ((p.array() < low_.array()).any() || (p.array() > high_.array()).any()) return false;
    bool inside = false;
    const std::size_t cell = cell_of(row(p, 1), row(p, 2));
    for (std::size_t i = first_[cell]; i < first_[cell + 1]; ++i) {
      const Triangle& face = mesh_.faces[faces_[i]];
      if (is_on(face, p)) return false;
      if (is_across(face, p) && is_before(face, p)) inside = !inside;
    }
    return inside;
  }

 private:
  static constexpr double kMostCells = 1024;       // in a row
  static constexpr std::size_t kMostEntries = 32;  // in cells, for a face on average

  int row(const Vec3& p, int axis) const {
    const double size = high_[axis] - low_[axis];
    return size > 0 ? std::min(side_ - 1, static_cast<int>(side_ * ((p[axis] - low_[axis]) / size))) : 0;
  }
  std::size_t cell_of(int y, int z) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(z);
  }

  std::pair<Vec3, Vec3> box_of(const Triangle& face) const {
    const Vec3 &a = mesh_.vertices[face[0]], &b = mesh_.vertices[face[1]], &c = mesh_.vertices[face[2]];
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  }

  template <class Visit>
  void visit_cells(const Triangle& face, Visit&& visit) const {
    const auto [low, high] = box_of(face);
    for (int y = row(low, 1); y <= row(high, 1); ++y) {
      for (int z = row(low, 2); z <= row(high, 2); ++z) visit(cell_of(y, z));
    }
  }

  std::size_t entries() const {
    std::size_t count = 0;
    for (const Triangle& face : mesh_.faces) {
      const auto box = box_of(face);
      const auto rows = [&](int axis) {
        return static_cast<std::size_t>(row(box.second, axis) - row(box.first, axis) + 1);
      };
      count += rows(1) * rows(2);
    }
    return count;
  }

  void fill() {
    first_.assign(cell_of(side_, 0) + 1, 0);
    for (const Triangle& face : mesh_.faces) visit_cells(face, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    faces_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      visit_cells(mesh_.faces[f], [&](std::size_t cell) { faces_[next[cell]++] = f; });
  }

  Kernel::Point_3 point(Index v) const {
    const Vec3& p = mesh_.vertices[v];
    return {p.x(), p.y(), p.z()};
  }

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

  // Whether the line through the point meets the face: it is within an odd number of its edges' way along y.
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

  // Whether a face that the line through the point meets is on the side of larger x.
  bool is_before(const Triangle& face, const Vec3& p) const {
    const double a = mesh_.vertices[face[0]].x(), b = mesh_.vertices[face[1]].x(), c = mesh_.vertices[face[2]].x();
    if (p.x() < std::min({a, b, c})) return true;
    if (p.x() > std::max({a, b, c})) return false;
    const Kernel::Point_3 q(p.x(), p.y(), p.z()), beyond(2 * high_.x() - low_.x(), p.y(), p.z());
    const auto side = CGAL::orientation(point(face[0]), point(face[1]), point(face[2]), q);
    return side != CGAL::orientation(point(face[0]), point(face[1]), point(face[2]), beyond);
  }

  const TriMesh& mesh_;
  Vec3 low_, high_;
  int side_ = 1;                    // cells in a row
  std::vector<std::size_t> first_;  // of every cell in faces_; one more for the end
  std::vector<Index> faces_;
};

}  // namespace

std::vector<bool> points_inside(const TriMesh& mesh, const std::vector<Vec3>& points) {
  check_closed(mesh);
  const RayCaster rays(mesh);
  std::vector<bool> inside;
  inside.reserve(points.size());
  for (const Vec3& p : points) inside.push_back(rays.is_inside(p));
  return inside;
}

}  // namespace vmesh
