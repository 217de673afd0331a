#include "solid/mend_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "vmesh/core/error.h"
#include "vmesh/mesh/volume_faces.h"

#include "solid/core_cells.h"
#include "solid/wedge_jacobian.h"
#include "solid/worst_first.h"

namespace vmesh {
namespace {

// Cells of a worse shape than this, by what they were at rest, see shape(), are worth work.
constexpr double kMendedShape = 0.2;
// Tetrahedra with a smaller sine of an angle between faces count as such, unless they had that at rest: 8 degrees.
constexpr double kFlatSine = 0.139, kLeastSine = 1e-6;
constexpr int kMostMendRounds = 20;
constexpr int kRingsAround = 2;  // of points around bad cells, which make room
// Steps of the search for a point's best position: from this share of its longest edge, halved each time.
constexpr double kFirstMendStep = 0.25;
constexpr int kMendHalvings = 7, kMostMendMoves = 4;
constexpr double kLeastMendGain = 0.005;  // of a shape; less is not worth a move

/// What decides whether a cell is positive, and the squares of its edges.
struct CellForm {
  std::array<double, 9> determinant, edge;
  std::size_t determinants = 0, edges = 0;
};

/// The corners of a cell, whose number tells what it is.
struct AnyCell {
  std::array<Index, 6> corner;
  std::size_t count;

  std::span<const Index> corners() const { return {corner.data(), count}; }
};

constexpr std::array<std::array<std::size_t, 2>, 6> kEdgesOfTetrahedron = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<std::size_t, 2>, 9> kEdgesOfWedge = {
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
constexpr std::array<std::array<std::size_t, 2>, 8> kEdgesOfPyramid = {
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
constexpr std::array<std::array<std::size_t, 4>, 4> kCornersOfPyramid = {
    {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};

double determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

CellForm form_of(const AnyCell& cell, const std::vector<Vec3>& points) {
  CellForm form;
  const auto at = [&](std::size_t i) -> const Vec3& { return points[cell.corner[i]]; };
  const auto add_edges = [&](const auto& edges) {
    for (const auto& [i, j] : edges) form.edge[form.edges++] = (at(j) - at(i)).squaredNorm();
  };
  if (cell.count == 4) {
    form.determinant[form.determinants++] = determinant(at(0), at(1), at(2), at(3));
    add_edges(kEdgesOfTetrahedron);
  } else if (cell.count == 6) {
    form.determinant = jacobian_coefficients({at(0), at(1), at(2), at(3), at(4), at(5)});
    form.determinants = form.determinant.size();
    add_edges(kEdgesOfWedge);
  } else {
    for (const auto& [a, b, c, d] : kCornersOfPyramid)
      form.determinant[form.determinants++] = determinant(at(a), at(b), at(c), at(d));
    add_edges(kEdgesOfPyramid);
  }
  return form;
}

/// A region without the number of its branch.
std::string_view part_of(std::string_view region) {
  const std::size_t end = region.find_last_not_of("0123456789");
  return end != std::string_view::npos && end > 0 && end + 1 < region.size() && region[end] == '_'
             ? region.substr(0, end)
             : region;
}

class CellMender {
 public:
  CellMender(VolumeMesh& mesh, const std::vector<Vec3>& rest) : mesh_(mesh), rest_(rest) {
    if (rest.size() != mesh.points.size())
      throw InvalidInput("the mesh has " + std::to_string(mesh.points.size()) + " points, but " +
                         std::to_string(rest.size()) + " are given at rest");
    check_volume_mesh(mesh);
    for_each_cell(mesh, [&](const auto& corners) {
      AnyCell& cell = cells_.emplace_back();
      cell.count = corners.size();
      std::copy(corners.begin(), corners.end(), cell.corner.begin());
    });
    around_begin_.assign(mesh.points.size() + 1, 0);
    for (const AnyCell& cell : cells_) {
      for (const Index v : cell.corners()) ++around_begin_[v + 1];
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v) around_begin_[v + 1] += around_begin_[v];
    around_.resize(around_begin_.back());
    std::vector<std::size_t> next(around_begin_.begin(), around_begin_.end() - 1);
    for (Index c = 0; c < cells_.size(); ++c) {
      for (const Index v : cells_[c].corners()) around_[next[v]++] = c;
    }
  }

  // Whatever is turned over first, for it decides.
  std::size_t run() {
    const std::vector<Vec3> before = mesh_.points;
    mend_bad();
    sees_angles_ = true;
    mend_bad();
    std::size_t moved = 0;
    for (std::size_t v = 0; v < before.size(); ++v) moved += mesh_.points[v] != before[v];
    return moved;
  }

 private:
  void mend_bad() {
    std::vector<Index> bad = bad_among_all();
    if (!bad.empty() && is_kept_.empty()) find_kept();
    for (int round = 0; round < kMostMendRounds && !bad.empty(); ++round) {
      bool any = false;
      for (const Index v : points_near(bad)) any = move(v) || any;
      if (!any) break;
      bad = bad_among_all();
    }
  }

  std::span<const Index> around(Index v) const {
    return {around_.data() + around_begin_[v], around_begin_[v + 1] - around_begin_[v]};
  }

  // 1 if the cell is similar to what it was, less if it is stretched, 0 if it is flat. If it is turned over, how far:
  // not the less for being stretched, or points would run away.
  double shape(Index c) const {
    const CellForm now = form_of(cells_[c], mesh_.points), rest = form_of(cells_[c], rest_);
    double least = std::numeric_limits<double>::infinity(), stretch = 0;
    for (std::size_t k = 0; k < now.determinants; ++k) {
      if (rest.determinant[k] > 0) least = std::min(least, now.determinant[k] / rest.determinant[k]);
    }
    if (!std::isfinite(least)) return 1;  // it was not positive at rest
    if (least <= 0) return least;
    for (std::size_t k = 0; k < now.edges; ++k) stretch += now.edge[k] / rest.edge[k];
    stretch /= static_cast<double>(now.edges);
    const double similar = least / (stretch * std::sqrt(stretch));
    return sees_angles_ && cells_[c].count == 4 ? std::min(similar, kMendedShape * evenness(c)) : similar;
  }

  // Of a tetrahedron: below 1 if it is flatter than is good, and than it was.
  double evenness(Index c) const {
    return sine_of(c, mesh_.points) / std::min(kFlatSine, std::max(sine_of(c, rest_), kLeastSine));
  }

  double sine_of(Index c, const std::vector<Vec3>& points) const {
    const auto& corner = cells_[c].corner;
    return vmesh::least_sine({points[corner[0]], points[corner[1]], points[corner[2]], points[corner[3]]});
  }

  std::vector<Index> bad_among_all() const {
    return worst_first(cells_.size(), kMendedShape, [&](Index c) { return shape(c); });
  }

  void find_kept() {
    is_kept_.assign(mesh_.points.size(), 0);
    const auto keep = [&](const CellFace& face) {
      for (const Index v : face) {
        if (v != kNone) is_kept_[v] = 1;
      }
    };
    for (const BoundaryFace& face : mesh_.boundary) keep(face.corners);
    const bool is_one_part = std::all_of(mesh_.region_names.begin(), mesh_.region_names.end(), [&](const auto& name) {
      return part_of(name) == part_of(mesh_.region_names.front());
    });
    if (is_one_part) return;
    const auto part = [&](Index cell) { return part_of(mesh_.region_names[mesh_.cell_region[cell]]); };
    for (const InnerFace& face : inner_faces(mesh_)) {
      if (part(face.owner) != part(face.neighbour)) keep(face.corners);
    }
  }

  // Of bad cells, worst first, then those around.
  std::vector<Index> points_near(const std::vector<Index>& bad) const {
    std::vector<Index> points;
    std::vector<char> is_in(mesh_.points.size(), 0);
    const auto add = [&](Index c) {
      for (const Index v : cells_[c].corners()) {
        if (is_in[v]) continue;
        is_in[v] = 1;
        points.push_back(v);
      }
    };
    for (const Index c : bad) add(c);
    for (int ring = 0; ring < kRingsAround; ++ring) {
      const std::size_t count = points.size();
      for (std::size_t i = 0; i < count; ++i) {
        for (const Index c : around(points[i])) add(c);
      }
    }
    std::erase_if(points, [&](Index v) { return is_kept_[v]; });
    return points;
  }

  double worst_around(Index v, double enough = -std::numeric_limits<double>::infinity()) const {
    double worst = std::numeric_limits<double>::infinity();
    for (const Index c : around(v)) {
      worst = std::min(worst, shape(c));
      if (worst < enough) break;
    }
    return worst;
  }

  double longest_edge(Index v) const {
    double longest = 0;
    for (const Index c : around(v)) {
      for (const Index w : cells_[c].corners()) longest = std::max(longest, (mesh_.points[w] - mesh_.points[v]).norm());
    }
    return longest;
  }

  // To where the worst cell around is as good as a search finds.
  bool move(Index v) {
    double best = worst_around(v);
    if (best >= 2 * kMendedShape) return false;
    bool any = false;
    double step = kFirstMendStep * longest_edge(v);
    for (int halving = 0; halving < kMendHalvings; ++halving, step /= 2) {
      bool moved = true;
      for (int k = 0; moved && k < kMostMendMoves; ++k) {
        moved = false;
        for (const Vec3& way : ways_) {
          const Vec3 before = mesh_.points[v];
          mesh_.points[v] += step * way;
          const double found = worst_around(v, best + kLeastMendGain);
          if (found > best + kLeastMendGain) {
            best = found;
            moved = any = true;
          } else {
            mesh_.points[v] = before;
          }
        }
      }
    }
    return any;
  }

  // Along the axes and the diagonals between them.
  static std::vector<Vec3> all_ways() {
    std::vector<Vec3> ways;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x != 0 || y != 0 || z != 0) ways.push_back(Vec3(x, y, z).normalized());
        }
      }
    }
    return ways;
  }

  VolumeMesh& mesh_;
  const std::vector<Vec3>& rest_;
  const std::vector<Vec3> ways_ = all_ways();
  std::vector<AnyCell> cells_;  // by their numbers
  std::vector<std::size_t> around_begin_;
  std::vector<Index> around_;  // cells at every point
  std::vector<char> is_kept_;
  bool sees_angles_ = false;
};

}  // namespace

std::size_t mend_cells(VolumeMesh& mesh, const std::vector<Vec3>& rest) { return CellMender(mesh, rest).run(); }

}  // namespace vmesh
