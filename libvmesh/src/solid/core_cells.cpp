#include "solid/core_cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "vmesh/mesh/volume_faces.h"

namespace vmesh {
namespace {

/// Of a tetrahedron, in order of its corners.
struct Faces {
  std::array<Vec3, 4> normal;  // opposite to every corner
  std::array<double, 4> twice_area;

  explicit Faces(const std::array<Vec3, 4>& p) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
      normal[i] = (b - a).cross(c - a);
      twice_area[i] = normal[i].norm();
    }
  }
};

double six_volumes(const std::array<Vec3, 4>& p) { return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]); }

double radius_ratio(const std::array<Vec3, 4>& p, const Faces& faces) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const Vec3 center = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  const auto& area = faces.twice_area;
  const double divisor = (area[0] + area[1] + area[2] + area[3]) * center.norm(), volumes = six_volumes(p);
  return divisor > 0 ? 6 * volumes * volumes / divisor : 0;
}

double least_sine(const std::array<Vec3, 4>& p, const Faces& faces) {
  const double volumes = std::abs(six_volumes(p));
  double least = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // Faces opposite to i and j meet at the edge between the other two corners.
      std::size_t k = 0;
      while (k == i || k == j) ++k;
      const std::size_t l = 6 - i - j - k;
      const double areas = faces.twice_area[i] * faces.twice_area[j];
      least = std::min(least, areas > 0 ? volumes * (p[k] - p[l]).norm() / areas : 0);
    }
  }
  return least;
}

double with_sign(double shape, const std::array<Vec3, 4>& p) { return six_volumes(p) > 0 ? shape : -shape; }

}  // namespace

double tetrahedron_shape(const std::array<Vec3, 4>& p) {
  constexpr double kWeight = 1.2;
  const Faces faces(p);
  return with_sign(std::min(kWeight * radius_ratio(p, faces), least_sine(p, faces)), p);
}

double least_sine(const std::array<Vec3, 4>& p) { return with_sign(least_sine(p, Faces(p)), p); }

CoreCells::CoreCells(const CoreSurface& surface, const Core& core)
    : cells_(core.tetrahedra),
      fixed_(static_cast<Index>(surface.mesh.vertices.size() + surface.beside.size())),
      points_(surface.mesh.vertices) {
  for (const LayerPoint& point : surface.beside) points_.push_back(point.position);
  points_.insert(points_.end(), core.added.begin(), core.added.end());
  around_.resize(points_.size());
  for (Index t = 0; t < cells_.size(); ++t) enter(t);
  if (!surface.beside.empty()) column_.resize(surface.mesh.vertices.size(), kNone);
  for (const LayerPoint& point : surface.beside) {
    column_[point.vertex] = point.vertex;
    column_.push_back(point.vertex);
  }
  for (const std::vector<Triangle>* faces : {&surface.mesh.faces, &surface.faces_beside}) {
    for (const Triangle& face : *faces) {
      for (std::size_t i = 0; i < 3; ++i) outside_.insert(std::minmax(face[i], face[(i + 1) % 3]));
    }
  }
}

void CoreCells::enter(Index t) {
  for (const Index v : cells_[t]) around_[v].push_back(t);
}

Index CoreCells::add_point(const Vec3& position) {
  points_.push_back(position);
  around_.emplace_back();
  return point_count() - 1;
}

void CoreCells::remove_last_point() {
  points_.pop_back();
  around_.pop_back();
}

double CoreCells::shape(const Tetrahedron& t) const {
  const std::array<Vec3, 4> corners = {points_[t[0]], points_[t[1]], points_[t[2]], points_[t[3]]};
  return crosses_layer(t) ? least_sine(corners) : tetrahedron_shape(corners);
}

bool CoreCells::crosses_layer(const Tetrahedron& cell) const {
  if (column_.empty()) return false;
  const auto column = [&](Index v) { return v < column_.size() ? column_[v] : kNone; };
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (column(cell[i]) != kNone && column(cell[i]) == column(cell[j])) return true;
    }
  }
  return false;
}

double CoreCells::worst_shape(std::span<const Tetrahedron> cells, double enough) const {
  double least = 1;
  for (const Tetrahedron& cell : cells) {
    least = std::min(least, shape(cell));
    if (least < enough) break;
  }
  return least;
}

std::vector<Tetrahedron> CoreCells::cells_of(std::span<const Index> numbers) const {
  std::vector<Tetrahedron> cells;
  cells.reserve(numbers.size());
  for (const Index t : numbers) cells.push_back(cells_[t]);
  return cells;
}

std::vector<Index> CoreCells::at_edge(Index a, Index b) const {
  std::vector<Index> shared;
  for (const Index t : around_[a]) {
    if (has(t, b)) shared.push_back(t);
  }
  return shared;
}

bool CoreCells::has(Index t, Index v) const {
  const Tetrahedron& cell = cells_[t];
  return std::find(cell.begin(), cell.end(), v) != cell.end();
}

Index CoreCells::beyond(Index t, std::size_t corner) const {
  const Tetrahedron& cell = cells_[t];
  return beyond(t, {cell[(corner + 1) % 4], cell[(corner + 2) % 4], cell[(corner + 3) % 4]});
}

Index CoreCells::beyond(Index t, const Triangle& face) const {
  for (const Index other : around_[face[0]]) {
    if (other != t && has(other, face[1]) && has(other, face[2])) return other;
  }
  return kNone;
}

std::vector<std::pair<Triangle, Index>> CoreCells::outer_faces(std::span<const Index> cavity) const {
  std::map<Triangle, std::pair<Triangle, Index>> outer;  // by their sorted corners
  for (const Index t : cavity) {
    for (const CellFace& face : faces_of(cells_[t])) {
      Triangle key = {face[0], face[1], face[2]};
      std::sort(key.begin(), key.end());
      if (!outer.try_emplace(key, Triangle{face[0], face[1], face[2]}, t).second) outer.erase(key);
    }
  }
  std::vector<std::pair<Triangle, Index>> faces;
  faces.reserve(outer.size());
  for (const auto& [key, face] : outer) faces.push_back(face);
  return faces;
}

std::vector<Index> CoreCells::ring(Index a, Index b) const {
  if (is_edge_of_surface(a, b)) return {};
  std::map<Index, Index> next;
  for (const Index t : at_edge(a, b)) {
    // Even permutations of corners keep the orientation: (a, b, u, w) is one of the cell's.
    const Tetrahedron& cell = cells_[t];
    const auto i = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), a) - cell.begin()),
               j = static_cast<std::size_t>(std::find(cell.begin(), cell.end(), b) - cell.begin());
    std::array<std::size_t, 2> others{};
    for (std::size_t k = 0, n = 0; k < 4; ++k) {
      if (k != i && k != j) others[n++] = k;
    }
    std::array<std::size_t, 4> order = {i, j, others[0], others[1]};
    bool is_odd = false;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = 0; l < k; ++l) is_odd ^= order[l] > order[k];
    }
    if (is_odd) std::swap(others[0], others[1]);
    next[cell[others[0]]] = cell[others[1]];
  }
  std::vector<Index> ring;
  if (next.empty()) return ring;
  for (Index v = next.begin()->first; ring.size() < next.size();) {
    ring.push_back(v);
    const auto found = next.find(v);
    if (found == next.end()) return {};
    v = found->second;
  }
  return next.at(ring.back()) == ring.front() ? ring : std::vector<Index>{};
}

void CoreCells::replace(std::span<const Index> cavity, std::span<const Tetrahedron> cells) {
  for (const Index t : cavity) {
    for (const Index v : cells_[t]) std::erase(around_[v], t);
    cells_[t].fill(kNone);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Index t = i < cavity.size() ? cavity[i] : static_cast<Index>(cells_.size());
    if (t == cells_.size()) cells_.emplace_back();
    cells_[t] = cells[i];
    enter(t);
  }
}

void CoreCells::write_to(Core& core) const {
  std::vector<Index> number(points_.size(), kNone);  // of those that cells still have
  for (Index v = 0; v < fixed_; ++v) number[v] = v;
  core.added.clear();
  for (Index v = fixed_; v < points_.size(); ++v) {
    if (around_[v].empty()) continue;
    number[v] = fixed_ + static_cast<Index>(core.added.size());
    core.added.push_back(points_[v]);
  }
  core.tetrahedra.clear();
  for (const auto& [a, b, c, d] : cells_) {
    if (a != kNone) core.tetrahedra.push_back({number[a], number[b], number[c], number[d]});
  }
}

}  // namespace vmesh
