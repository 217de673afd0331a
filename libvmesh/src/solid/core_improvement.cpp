#include "solid/core_improvement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "solid/layer_columns.h"
#include "solid/worst_first.h"

namespace vmesh {
namespace {

// Tetrahedra of a worse shape than this (see tetrahedron_shape(); with an angle below 17 degrees) are worth work.
constexpr double kGoodShape = 0.3;
constexpr int kRounds = 6, kRoundsOfGrowing = 2;
// Steps of a search for the best position of a point: from this share of the edges around it, halved each time.
constexpr double kFirstStep = 0.25;
constexpr int kHalvings = 6, kTrialHalvings = 3;
constexpr int kMostMoves = 4;  // of one length
// A change must be worth its while, else rounds do not end.
constexpr double kLeastGain = 1.02;
// Factors of the thickness of layers that are tried.
constexpr std::array<double, 6> kColumnSteps = {0.8, 0.9, 0.95, 0.98, 1.03, 1.1};
// The same for all corners of a tetrahedron together.
constexpr std::array<double, 2> kStepsTogether = {0.5, 0.2};
constexpr std::size_t kMostAround = 8;   // cells at an edge that is swapped
constexpr std::size_t kMostCavity = 16;  // cells that a point replaces

/// The best cells around two points in place of those at their edge.
class RingFilling {
 public:
  RingFilling(const CoreCells& cells, const std::vector<Index>& ring, Index a, Index b)
      : cells_(cells), ring_(ring), a_(a), b_(b), n_(ring.size()), best_(n_ * n_, 1), middle_(n_ * n_, 0) {
    for (std::size_t length = 2; length < n_; ++length) {
      for (std::size_t i = 0; i + length < n_; ++i) divide(i, i + length);
    }
  }

  double shape() const { return best_[n_ - 1]; }
  std::vector<Tetrahedron> filled() const {
    std::vector<Tetrahedron> cells;
    add(0, n_ - 1, cells);
    return cells;
  }

 private:
  Tetrahedron above(std::size_t i, std::size_t k, std::size_t j) const { return {ring_[i], ring_[k], ring_[j], b_}; }
  Tetrahedron below(std::size_t i, std::size_t k, std::size_t j) const { return {ring_[i], ring_[j], ring_[k], a_}; }

  // The polygon of the ring's vertices from i to j is divided by a triangle.
  void divide(std::size_t i, std::size_t j) {
    double& best = best_[i * n_ + j];
    best = -1;
    for (std::size_t k = i + 1; k < j; ++k) {
      double shape = std::min(best_[i * n_ + k], best_[k * n_ + j]);
      if (shape > best) shape = std::min(shape, cells_.shape(above(i, k, j)));
      if (shape > best) shape = std::min(shape, cells_.shape(below(i, k, j)));
      if (shape <= best) continue;
      best = shape;
      middle_[i * n_ + j] = k;
    }
  }

  void add(std::size_t i, std::size_t j, std::vector<Tetrahedron>& cells) const {
    if (j < i + 2) return;
    const std::size_t k = middle_[i * n_ + j];
    cells.push_back(above(i, k, j));
    cells.push_back(below(i, k, j));
    add(i, k, cells);
    add(k, j, cells);
  }

  const CoreCells& cells_;
  const std::vector<Index>& ring_;
  Index a_, b_;
  std::size_t n_;
  std::vector<double> best_;  // of the polygon from i to j, at n i + j
  std::vector<std::size_t> middle_;
};

class Improver {
 public:
  Improver(CoreCells& cells, LayerColumns* columns) : cells_(cells), columns_(columns) {}

  void run() {
    bool any = true;
    for (round_ = 0; any && round_ < kRounds; ++round_) {
      any = false;
      for (const Index t : bad_tetrahedra(kGoodShape)) any = improve(t) || any;
    }
  }

  void thin_at_bad(double limit) {
    for (const Index t : bad_tetrahedra(limit)) {
      for (const double step : kStepsTogether) keep_if_better(columns_->thin_together(cells_[t], step));
    }
  }

 private:
  /// What is to replace a few cells.
  struct Replacement {
    double shape = 0;
    std::vector<Index> cavity;
    std::vector<Tetrahedron> cells;
    Vec3 position = Vec3::Zero();  // of the point that is added
  };

  bool is_bad(Index t) const { return cells_.is_there(t) && cells_.shape(cells_[t]) < kGoodShape; }

  std::vector<Index> bad_tetrahedra(double limit) const {
    return worst_first(cells_.size(), limit, [&](Index t) {
      return cells_.is_there(t) ? cells_.shape(cells_[t]) : std::numeric_limits<double>::infinity();
    });
  }

  bool improve(Index t) {
    if (!is_bad(t) || was_in_vain(t)) return false;  // it has become better already, or cannot
    const Tetrahedron corners = cells_[t];
    const bool any = change_around(t);
    if (any) {
      for (const Index v : corners) note_change(v);
    } else {
      tried_[t] = changes_;
    }
    return any;
  }

  // What has been tried where nothing has changed since.
  bool was_in_vain(Index t) {
    tried_.resize(cells_.size(), 0);
    changed_.resize(cells_.point_count(), 1);
    const Tetrahedron& cell = cells_[t];
    return std::all_of(cell.begin(), cell.end(), [&](Index v) { return changed_[v] <= tried_[t]; });
  }

  // At a point, which its neighbours see.
  void note_change(Index v) {
    ++changes_;
    changed_.resize(cells_.point_count(), changes_);
    for (const Index t : cells_.around(v)) {
      for (const Index w : cells_[t]) changed_[w] = changes_;
    }
  }

  bool change_around(Index t) {
    bool any = false;
    for (const Index v : Tetrahedron(cells_[t])) any = move(v) || any;
    if (is_bad(t)) any = swap(t) || any;
    if (is_bad(t)) any = insert_a_point(t) || any;
    return any;
  }

  bool move(Index v) {
    if (columns_ && columns_->may_move(v)) return move_column(v);
    if (!cells_.is_added(v)) return false;
    const std::vector<Tetrahedron> cells = cells_.cells_of(cells_.around(v));
    const double before = cells_.worst_shape(cells);
    return settle(v, cells, kHalvings) > before;
  }

  static double needed_after(double before) { return before + (kLeastGain - 1) * std::abs(before); }

  /// Moves a point so that the worst of these cells, all at it, becomes as good as a search finds. Returns how good.
  double settle(Index v, const std::vector<Tetrahedron>& cells, int halvings) {
    double step = 0;
    for (const Tetrahedron& cell : cells) {
      for (const Index w : cell) step = std::max(step, (cells_.position(w) - cells_.position(v)).norm());
    }
    step *= kFirstStep;
    double best = cells_.worst_shape(cells);
    for (int halving = 0; halving < halvings; ++halving, step /= 2) {
      bool moved = true;
      for (int move = 0; moved && move < kMostMoves; ++move) {
        moved = false;
        for (const Vec3& way : kWays) {
          const Vec3 before = cells_.position(v);
          cells_.position(v) += step * way;
          const double needed = needed_after(best), found = cells_.worst_shape(cells, needed);
          if (found > needed) {
            best = found;
            moved = true;
          } else {
            cells_.position(v) = before;
          }
        }
      }
    }
    return best;
  }

  bool move_column(Index v) {
    bool any = false;
    for (const double step : kColumnSteps) {
      for (int move = 0; move < kMostMoves && try_thickness(v, step * columns_->thickness_mm(v)); ++move) any = true;
    }
    return any;
  }

  bool try_thickness(Index v, double thickness_mm) { return keep_if_better(columns_->set_thickness(v, thickness_mm)); }

  bool keep_if_better(const std::vector<LayerColumns::Change>& changes) {
    if (changes.empty()) return false;
    std::vector<Index> around;
    for (const auto& change : changes) {
      const std::vector<Index>& cells = cells_.around(change.vertex);
      around.insert(around.end(), cells.begin(), cells.end());
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    const std::vector<Tetrahedron> cells = cells_.cells_of(around);
    const double needed = needed_after(cells_.worst_shape(cells));
    put_at_ends(changes);
    if (cells_.worst_shape(cells, needed) > needed) return true;
    columns_->take_back(changes);
    put_at_ends(changes);
    return false;
  }

  void put_at_ends(const std::vector<LayerColumns::Change>& changes) {
    for (const auto& change : changes) cells_.position(change.vertex) = columns_->end(change.vertex);
  }

  bool swap(Index t) {
    const Tetrahedron cell = cells_[t];
    Replacement best;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) try_without_edge(cell[i], cell[j], best);
      try_without_face(t, i, best);
    }
    if (best.cavity.empty()) return false;
    cells_.replace(best.cavity, best.cells);
    return true;
  }

  void try_without_edge(Index a, Index b, Replacement& best) const {
    const std::vector<Index> ring = cells_.ring(a, b);
    if (ring.size() < 3 || ring.size() > kMostAround) return;
    const std::vector<Index> cavity = cells_.at_edge(a, b);
    const RingFilling filling(cells_, ring, a, b);
    take_if_better(cavity, filling.filled(), filling.shape(), {}, best);
  }

  void try_without_face(Index t, std::size_t corner, Replacement& best) const {
    const Index other = cells_.beyond(t, corner);
    if (other == kNone) return;
    const std::vector<Index> cavity = {t, other};
    const Index top = cells_[t][corner];
    Index bottom = kNone;
    for (const Index v : cells_[other]) {
      if (!cells_.has(t, v)) bottom = v;
    }
    std::vector<Tetrahedron> around;
    for (const auto& [face, of] : cells_.outer_faces(cavity)) {
      // Of the three faces at the top, seen from outside: with the bottom, which is within, they are the new cells.
      if (std::find(face.begin(), face.end(), top) != face.end()) around.push_back({face[0], face[2], face[1], bottom});
    }
    take_if_better(cavity, around, cells_.worst_shape(around), {}, best);
  }

  // There must not be more bad cells than before either, or where nothing helps there would be more and more of them.
  void take_if_better(const std::vector<Index>& cavity, const std::vector<Tetrahedron>& cells, double shape,
                      const Vec3& position, Replacement& best) const {
    if (!(shape > best.shape)) return;
    const std::vector<Tetrahedron> before = cells_.cells_of(cavity);
    if (!(shape > kLeastGain * std::max(cells_.worst_shape(before), 0.0))) return;
    if (shape < kGoodShape && bad_count(cells) > bad_count(before)) return;
    best = {shape, cavity, cells, position};
  }

  std::ptrdiff_t bad_count(const std::vector<Tetrahedron>& cells) const {
    return std::count_if(cells.begin(), cells.end(),
                         [&](const Tetrahedron& cell) { return cells_.shape(cell) < kGoodShape; });
  }

  bool insert_a_point(Index t) {
    const Tetrahedron cell = cells_[t];
    Replacement best;
    std::vector<Index> all = {t};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (!cells_.is_edge_of_surface(cell[i], cell[j]))
          try_insertion(cells_.at_edge(cell[i], cell[j]), (cells_.position(cell[i]) + cells_.position(cell[j])) / 2,
                        best);
      }
      const Index other = cells_.beyond(t, i);
      if (other == kNone) continue;
      all.push_back(other);
      try_insertion({t, other}, center_of(cell), best);
    }
    try_insertion(all, center_of(cell), best);
    if (best.shape < kGoodShape && round_ < kRoundsOfGrowing) try_growing_cavity(t, best);
    if (best.cavity.empty()) return false;
    const Index m = cells_.add_point(best.position);
    cells_.replace(best.cavity, best.cells);
    move(m);
    return true;
  }

  Vec3 center_of(const Tetrahedron& cell) const {
    return (cells_.position(cell[0]) + cells_.position(cell[1]) + cells_.position(cell[2]) + cells_.position(cell[3])) /
           4;
  }

  // With the outer faces of a cavity as bases and `m` as their top.
  std::vector<Tetrahedron> filled(const std::vector<Index>& cavity, Index m) const {
    std::vector<Tetrahedron> cells;
    for (const auto& [face, t] : cells_.outer_faces(cavity)) cells.push_back({face[0], face[2], face[1], m});
    return cells;
  }

  // Returns where the point is best.
  Vec3 try_insertion(const std::vector<Index>& cavity, const Vec3& start, Replacement& best) {
    const Index m = cells_.add_point(start);
    const std::vector<Tetrahedron> cells = filled(cavity, m);
    const double after = settle(m, cells, kTrialHalvings);
    const Vec3 position = cells_.position(m);
    take_if_better(cavity, cells, after, position, best);
    cells_.remove_last_point();
    return position;
  }

  // From a bad cell on, the cell beyond the face over which the point is worst is replaced too.
  void try_growing_cavity(Index t, Replacement& best) {
    std::vector<Index> cavity = {t};
    Vec3 position = center_of(cells_[t]);
    while (cavity.size() < kMostCavity) {
      const Index next = worst_beyond(cavity, position);
      if (next == kNone) return;
      cavity.push_back(next);
      position = try_insertion(cavity, position, best);
    }
  }

  Index worst_beyond(const std::vector<Index>& cavity, const Vec3& position) {
    const Index m = cells_.add_point(position);
    double least = 1;
    Index worst = kNone;
    for (const auto& [face, t] : cells_.outer_faces(cavity)) {
      const double shape = cells_.shape({face[0], face[2], face[1], m});
      if (shape >= least) continue;
      const Index other = cells_.beyond(t, face);
      if (other == kNone) continue;
      least = shape;
      worst = other;
    }
    cells_.remove_last_point();
    return worst;
  }

  static inline const std::array<Vec3, 6> kWays = {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                                                   -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};

  CoreCells& cells_;
  LayerColumns* columns_;  // null: the surface stays
  int round_ = 0;
  // Numbers of changes: so far, of the last one at a point, and when a cell was tried in vain.
  std::size_t changes_ = 1;
  std::vector<std::size_t> changed_, tried_;
};

BadPlaces bad_places(const CoreCells& cells, double limit) {
  BadPlaces places;
  std::set<Index> bad;
  for (Index t = 0; t < cells.size(); ++t) {
    if (!cells.is_there(t)) continue;
    const double shape = cells.shape(cells[t]);
    places.least = std::min(places.least, shape);
    if (shape < limit) bad.insert(cells[t].begin(), cells[t].end());
  }
  places.vertices.assign(bad.begin(), bad.end());
  return places;
}

template <class Change>
BadPlaces change_layers(CoreSurface& surface, Core& core, const WallFrame& frame, LayerStack& layers, double limit,
                        const Change& change) {
  const std::vector<double> before = layers.reached_mm;
  CoreCells cells(surface, core);
  LayerColumns columns(frame, layers);
  Improver improver(cells, &columns);
  change(improver);
  for (Index v = 0; v < frame.position.size(); ++v) {
    if (layers.reached_mm[v] < before[v]) layers.limit[v] = LayerLimit::shape;
    surface.mesh.vertices[v] = layers.at(frame, v, 1);
  }
  cells.write_to(core);
  return bad_places(cells, limit);
}

}  // namespace

void improve_core(const CoreSurface& surface, Core& core) {
  CoreCells cells(surface, core);
  Improver(cells, nullptr).run();
  cells.write_to(core);
}

BadPlaces improve_core(CoreSurface& surface, Core& core, const WallFrame& frame, LayerStack& layers, double limit) {
  return change_layers(surface, core, frame, layers, limit, [](Improver& improver) { improver.run(); });
}

BadPlaces thin_at_bad_places(CoreSurface& surface, Core& core, const WallFrame& frame, LayerStack& layers,
                             double limit) {
  return change_layers(surface, core, frame, layers, limit, [&](Improver& improver) { improver.thin_at_bad(limit); });
}

}  // namespace vmesh
