#include "solid/core_improvement.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "vmesh/mesh/volume_faces.h"

namespace vmesh {
namespace {

// Tetrahedra of a worse shape than this (see BadPlaces; with an angle below 15 degrees) are worth work.
constexpr double kGoodShape = 0.26;
constexpr int kRounds = 8;
// Steps of a search for the best position of a point: from this share of the edges around it, halved each time.
constexpr double kFirstStep = 0.25;
constexpr int kHalvings = 6, kTrialHalvings = 3;
constexpr int kMostMoves = 4;  // of one length
// A change must be worth its while, else rounds do not end.
constexpr double kLeastGain = 1.02;

double radius_ratio(const std::array<Vec3, 4>& p, double six_volumes, double twice_area) {
  const Vec3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const Vec3 center = a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  const double divisor = twice_area * center.norm();
  return divisor > 0 ? 6 * six_volumes * six_volumes / divisor : 0;
}

class Improver {
 public:
  Improver(const CoreSurface& surface, Core& core)
      : core_(core), fixed_(static_cast<Index>(surface.mesh.vertices.size())), points_(surface.mesh.vertices) {
    points_.insert(points_.end(), core.added.begin(), core.added.end());
    around_.resize(points_.size());
    for (Index t = 0; t < core.tetrahedra.size(); ++t) enter(t);
    for (const Triangle& face : surface.mesh.faces) {
      for (std::size_t i = 0; i < 3; ++i) outside_.insert(std::minmax(face[i], face[(i + 1) % 3]));
    }
  }

  void run() {
    bool any = true;
    for (int round = 0; any && round < kRounds; ++round) {
      any = false;
      for (const Index t : bad_tetrahedra()) any = improve(t) || any;
    }
    core_.added.assign(points_.begin() + fixed_, points_.end());
  }

 private:
  void enter(Index t) {
    for (const Index v : core_.tetrahedra[t]) around_[v].push_back(t);
  }

  double quality(const Tetrahedron& t) const {
    return tetrahedron_shape({points_[t[0]], points_[t[1]], points_[t[2]], points_[t[3]]});
  }
  // Of all cells, or of the first ones if that is below `enough` already.
  double worst(const std::vector<Tetrahedron>& cells, double enough = -1) const {
    double least = 1;
    for (const Tetrahedron& cell : cells) {
      least = std::min(least, quality(cell));
      if (least < enough) break;
    }
    return least;
  }

  // Worst first.
  std::vector<Index> bad_tetrahedra() const {
    std::vector<std::pair<double, Index>> bad;
    for (Index t = 0; t < core_.tetrahedra.size(); ++t) {
      const double q = quality(core_.tetrahedra[t]);
      if (q < kGoodShape) bad.emplace_back(q, t);
    }
    std::sort(bad.begin(), bad.end());
    std::vector<Index> numbers;
    for (const auto& [q, t] : bad) numbers.push_back(t);
    return numbers;
  }

  bool improve(Index t) {
    const Tetrahedron cell = core_.tetrahedra[t];
    if (quality(cell) >= kGoodShape) return false;  // it has become better already
    bool any = false;
    for (const Index v : cell) any = (v >= fixed_ && move(v)) || any;
    if (quality(core_.tetrahedra[t]) >= kGoodShape) return any;
    return insert_a_point(t) || any;
  }

  std::vector<Tetrahedron> cells_at(Index v) const {
    std::vector<Tetrahedron> cells;
    for (const Index t : around_[v]) cells.push_back(core_.tetrahedra[t]);
    return cells;
  }

  /// Moves a point so that the worst of these cells, all at it, becomes as good as a search finds. Returns how good.
  double settle(Index v, const std::vector<Tetrahedron>& cells, int halvings) {
    double step = 0;
    for (const Tetrahedron& cell : cells) {
      for (const Index w : cell) step = std::max(step, (points_[w] - points_[v]).norm());
    }
    step *= kFirstStep;
    double best = worst(cells);
    for (int halving = 0; halving < halvings; ++halving, step /= 2) {
      bool moved = true;
      for (int move = 0; moved && move < kMostMoves; ++move) {
        moved = false;
        for (const Vec3& way : kWays) {
          const Vec3 before = points_[v];
          points_[v] += step * way;
          const double needed = best + (kLeastGain - 1) * std::abs(best), found = worst(cells, needed);
          if (found > needed) {
            best = found;
            moved = true;
          } else {
            points_[v] = before;
          }
        }
      }
    }
    return best;
  }

  bool move(Index v) {
    const std::vector<Tetrahedron> cells = cells_at(v);
    const double before = worst(cells);
    return settle(v, cells, kHalvings) > before;
  }

  // A point with which the faces of a cavity form new cells.
  struct Insertion {
    double quality = 0;
    std::vector<Index> cavity;  // cells to be replaced
    Vec3 position = Vec3::Zero();
  };

  bool insert_a_point(Index t) {
    const Tetrahedron cell = core_.tetrahedra[t];
    Insertion best;
    std::vector<Index> all = {t};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!outside_.contains(std::minmax(cell[i], cell[j])))
          try_insertion(at_edge(cell[i], cell[j]), (points_[cell[i]] + points_[cell[j]]) / 2, best);
      }
      const Index other = beyond(t, i);
      if (other == kNone) continue;
      all.push_back(other);
      try_insertion({t, other}, center_of(cell), best);
    }
    try_insertion(all, center_of(cell), best);
    if (best.cavity.empty()) return false;
    insert(best);
    return true;
  }

  Vec3 center_of(const Tetrahedron& cell) const {
    return (points_[cell[0]] + points_[cell[1]] + points_[cell[2]] + points_[cell[3]]) / 4;
  }

  // Cells with both of two points.
  std::vector<Index> at_edge(Index a, Index b) const {
    std::vector<Index> shared;
    for (const Index t : around_[a]) {
      if (has(t, b)) shared.push_back(t);
    }
    return shared;
  }

  bool has(Index t, Index v) const {
    const Tetrahedron& cell = core_.tetrahedra[t];
    return std::find(cell.begin(), cell.end(), v) != cell.end();
  }

  // The cell on the other side of the face opposite to a corner; kNone outside.
  Index beyond(Index t, std::size_t corner) const {
    const Tetrahedron& cell = core_.tetrahedra[t];
    const Index a = cell[(corner + 1) % 4], b = cell[(corner + 2) % 4], c = cell[(corner + 3) % 4];
    for (const Index other : around_[a]) {
      if (other != t && has(other, b) && has(other, c)) return other;
    }
    return kNone;
  }

  // With the faces of a cavity as bases and `m` as their top.
  std::vector<Tetrahedron> filled(const std::vector<Index>& cavity, Index m) const {
    std::map<Triangle, CellFace> outer;  // by their sorted corners
    for (const Index t : cavity) {
      for (const CellFace& face : faces_of(core_.tetrahedra[t])) {
        Triangle key = {face[0], face[1], face[2]};
        std::sort(key.begin(), key.end());
        if (!outer.try_emplace(key, face).second) outer.erase(key);
      }
    }
    std::vector<Tetrahedron> cells;
    for (const auto& [key, face] : outer) cells.push_back({face[0], face[2], face[1], m});
    return cells;
  }

  void try_insertion(const std::vector<Index>& cavity, const Vec3& start, Insertion& best) {
    double before = 1;
    for (const Index t : cavity) before = std::min(before, quality(core_.tetrahedra[t]));
    const auto m = static_cast<Index>(points_.size());
    points_.push_back(start);
    const double after = settle(m, filled(cavity, m), kTrialHalvings);
    if (after > kLeastGain * std::max(before, 0.0) && after > best.quality) best = {after, cavity, points_[m]};
    points_.pop_back();
  }

  void insert(const Insertion& insertion) {
    const auto m = static_cast<Index>(points_.size());
    points_.push_back(insertion.position);
    around_.emplace_back();
    const std::vector<Tetrahedron> cells = filled(insertion.cavity, m);
    for (const Index t : insertion.cavity) {
      for (const Index v : core_.tetrahedra[t]) std::erase(around_[v], t);
    }
    // There are more new cells than old ones.
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Index t = i < insertion.cavity.size() ? insertion.cavity[i] : static_cast<Index>(core_.tetrahedra.size());
      if (t == core_.tetrahedra.size()) core_.tetrahedra.emplace_back();
      core_.tetrahedra[t] = cells[i];
      enter(t);
    }
    move(m);
  }

  static inline const std::array<Vec3, 6> kWays = {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                                                   -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};

  Core& core_;
  Index fixed_;  // points of the surface
  std::vector<Vec3> points_;
  std::vector<std::vector<Index>> around_;     // tetrahedra at every point
  std::set<std::pair<Index, Index>> outside_;  // edges of the surface
};

}  // namespace

double tetrahedron_shape(const std::array<Vec3, 4>& p) {
  constexpr double kWeight = 1.2;
  std::array<Vec3, 4> normal;  // opposite to every corner
  double twice_area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
    normal[i] = (b - a).cross(c - a);
    twice_area += normal[i].norm();
  }
  const double six_volumes = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
  double least = kWeight * radius_ratio(p, six_volumes, twice_area);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // Faces opposite to i and j meet at the edge between the other two corners.
      std::size_t k = 0;
      while (k == i || k == j) ++k;
      const std::size_t l = 6 - i - j - k;
      const double areas = normal[i].norm() * normal[j].norm();
      least = std::min(least, areas > 0 ? std::abs(six_volumes) * (p[k] - p[l]).norm() / areas : 0);
    }
  }
  return six_volumes > 0 ? least : -least;
}

void improve_core(const CoreSurface& surface, Core& core) { Improver(surface, core).run(); }

BadPlaces bad_places(const CoreSurface& surface, const Core& core, double limit) {
  const auto fixed = static_cast<Index>(surface.mesh.vertices.size());
  const auto at = [&](Index v) -> const Vec3& { return v < fixed ? surface.mesh.vertices[v] : core.added[v - fixed]; };
  BadPlaces places;
  std::set<Index> vertices;
  for (const auto& [a, b, c, d] : core.tetrahedra) {
    const double shape = tetrahedron_shape({at(a), at(b), at(c), at(d)});
    places.least = std::min(places.least, shape);
    if (shape >= limit) continue;
    for (const Index v : {a, b, c, d}) {
      if (v < fixed) vertices.insert(v);
    }
  }
  places.vertices.assign(vertices.begin(), vertices.end());
  return places;
}

}  // namespace vmesh
