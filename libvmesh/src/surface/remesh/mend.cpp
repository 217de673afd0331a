#include "surface/remesh/mend.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <CGAL/boost/graph/Euler_operations.h>

namespace vmesh {
namespace {

constexpr int kRounds = 20;          // through all bad faces; idle 14 to 28
constexpr double kTolerance = 1e-3;  // vessel radii: distance of an improved vertex from its lift
constexpr double kPaysOff = 0.998;   // ratio of the worst skewness around after a step to that before; safe 0.7 to 1.4
// The same where improving crowded surfaces. Measured on short stars of 1,000 branches: with kPaysOff instead,
// improving takes three times as long, and the mean skewness is the same (.095).
constexpr double kPaysOffInPits = 0.95;

// Cosine between two faces down to which improving may fold their edge further; idle 0.5 to 0.85 on ten synthetic
// trees.
constexpr double kFlat = 0.85;
// Mean distance from the boundary of the faces around a vertex that an improving move may lead to: relative to that
// before, and in vessel radii (about that of an even tube). Measured on fourteen trees: without this bound the mean
// distance of one tree grows by 1.4 %; with a tighter one the maximum skewness grows by up to 9 %.
constexpr double kFarther = 1.03, kNear = 0.05;
constexpr double kMostOffBoundary = 0.15;  // edge lengths by which one step may leave the boundary; safe 0.1 to 0.21
constexpr double kDiagonal = 0.70710678118654752;
constexpr std::array<std::array<double, 2>, 8> kDirections = {{{1, 0},
                                                               {kDiagonal, kDiagonal},
                                                               {0, 1},
                                                               {-kDiagonal, kDiagonal},
                                                               {-1, 0},
                                                               {-kDiagonal, -kDiagonal},
                                                               {0, -1},
                                                               {kDiagonal, -kDiagonal}}};

// Steps per face that improving tries: where the best are refused, most are. Measured on fourteen trees: without this
// bound the average maximum skewness is 0.3 % less.
constexpr std::size_t kTries = 8;
constexpr std::size_t kFacesPerPoll = 64;  // a few milliseconds

enum class Keeps { nothing, to_boundary };

// Applies the most helpful step at one face after another.
class Mender {
 public:
  Mender(BoundSurface& surface, double limit, Keeps keeps, const Progress& progress)
      : surface_(surface), mesh_(surface.mesh), limit_(limit), keeps_(keeps), progress_(progress) {}

  bool run() {
    const auto all = mesh_.faces();
    std::vector<Face> bad = bad_faces({all.begin(), all.end()});
    if (bad.empty()) return false;
    surface_.guard_crossings();
    for (int round = 0; round < kRounds && !bad.empty(); ++round) {
      changed_.clear();
      std::size_t visited = 0;
      for (const Face f : bad) {
        if (visited++ % kFacesPerPoll == 0) report_progress(progress_, "mend", 0);
        if (!mesh_.is_removed(f) && skewness(f) > limit_) mend(f);
      }
      if (changed_.empty()) break;
      bad = bad_faces(std::move(changed_));
    }
    return true;
  }

 private:
  enum class Kind { flip, collapse, split, move };
  struct Repair {
    Kind kind;
    Halfedge edge;  // of a flip, collapse or split
    Vertex vertex;  // of a move
    Vec3 place;
    double before, worst;  // worst skewness around, before and afterwards
  };

  // Worst first.
  std::vector<Face> bad_faces(std::vector<Face> faces) const {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::vector<std::pair<double, Face>> order;
    for (const Face f : faces) {
      if (mesh_.is_removed(f) || surface_.is_lid(f)) continue;
      const double s = skewness(f);
      if (s > limit_) order.emplace_back(-s, f);
    }
    std::sort(order.begin(), order.end());
    faces.clear();
    for (const auto& [_, f] : order) faces.push_back(f);
    return faces;
  }

  double skewness(Face f) const {
    const Halfedge h = mesh_.halfedge(f);
    return skewness(mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h)));
  }

  double skewness(Vertex a, Vertex b, Vertex c) const { return skewness(a, b, c, mesh_.point(a)); }
  // That of abc once `a` is at `place`.
  double skewness(Vertex a, Vertex b, Vertex c, const Vec3& place) const {
    return surface_.metric(a, b, c).skewness(place, mesh_.point(b), mesh_.point(c));
  }

  bool mend(Face f) {
    errors_.clear();
    std::vector<Repair> steps;
    for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
      add_flip(h, steps);
      add_collapses(h, steps);
      if (keeps_ == Keeps::nothing) add_split(h, steps);
      add_moves(mesh_.target(h), steps);
    }
    std::stable_sort(steps.begin(), steps.end(), [](const Repair& a, const Repair& b) { return a.worst < b.worst; });
    if (keeps_ == Keeps::to_boundary && steps.size() > kTries) steps.resize(kTries);
    return std::any_of(steps.begin(), steps.end(), [&](const Repair& step) { return take(step); });
  }

  bool any_is_lid(std::initializer_list<Vertex> vertices) const {
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](Vertex v) { return surface_[v].role == BoundSurface::Role::lid; });
  }

  // Offers a step if it lowers the worst skewness of the faces it changes.
  void offer(const Repair& step, std::vector<Repair>& steps) const {
    if (step.worst < pays_off_ * step.before) steps.push_back(step);
  }

  void add_flip(Halfedge h, std::vector<Repair>& steps) const {
    const Halfedge o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (any_is_lid({a, b, c, d})) return;
    if ((surface_.held(a) && surface_.held(b)) || (surface_.held(c) && surface_.held(d))) return;
    if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge()) return;
    const double worst = std::max(skewness(c, d, b), skewness(d, c, a));
    const double before = std::max(skewness(mesh_.face(h)), skewness(mesh_.face(o)));
    if (keeps_ == Keeps::to_boundary && !stays_flat(a, b, c, d)) return;
    offer({Kind::flip, h, {}, Vec3::Zero(), before, worst}, steps);
  }

  void add_collapses(Halfedge h, std::vector<Repair>& steps) const {
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    if (surface_.held(a) || surface_.held(b)) return;
    if (!CGAL::Euler::does_satisfy_link_condition(mesh_.edge(h), mesh_)) return;
    const double before = std::max(worst_around(a), worst_around(b));
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vec3 place = (1 - t) * mesh_.point(a) + t * mesh_.point(b);
      offer({Kind::collapse, h, {}, place, before, worst_with_both(a, b, place, pays_off_ * before)}, steps);
    }
  }

  // A split at the midpoint, which does not move the surface.
  void add_split(Halfedge h, std::vector<Repair>& steps) const {
    const Halfedge o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (any_is_lid({a, b, c, d})) return;
    if (surface_.held(a) && surface_.held(b)) return;
    const Vec3 middle = 0.5 * (mesh_.point(a) + mesh_.point(b));
    double worst = 0;
    for (const Vertex apex : {c, d}) {
      for (const Vertex end : {a, b})
        worst = std::max(worst, surface_.metric(apex, a, b).skewness(mesh_.point(apex), mesh_.point(end), middle));
    }
    const double before = std::max(skewness(mesh_.face(h)), skewness(mesh_.face(o)));
    offer({Kind::split, h, {}, middle, before, worst}, steps);
  }

  // Moves to the neighbours' centroid and to points around the vertex, at ever smaller distances.
  void add_moves(Vertex v, std::vector<Repair>& steps) const {
    if (surface_.held(v)) return;
    Vec3 center = Vec3::Zero();
    double length = 0;
    const ElongatedMetric metric(surface_[v].elongation);
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      center += mesh_.point(mesh_.source(h));
      length += metric.shrunk(mesh_.point(mesh_.source(h)) - mesh_.point(v)).norm();
    }
    center /= static_cast<double>(mesh_.degree(v));
    length /= static_cast<double>(mesh_.degree(v));
    const auto [before, at_worst] = worst_face_around(v);
    const auto offer_place = [&, before = before, at_worst = at_worst](const Vec3& place) {
      offer({Kind::move, {}, v, place, before, worst_with(at_worst, v, place, pays_off_ * before)}, steps);
    };
    const Vec3 normal = surface_[v].gradient, side = towards_neighbour(v, normal), across = normal.cross(side);
    if (keeps_ == Keeps::to_boundary) center -= normal.dot(center - mesh_.point(v)) * normal;
    for (const double share : {0.25, 0.5, 1.0}) offer_place(mesh_.point(v) + share * (center - mesh_.point(v)));
    for (const double share : {0.6, 0.4, 0.2, 0.1, 0.05, 0.02}) {
      if (share < kMostOffBoundary && keeps_ == Keeps::nothing) {
        for (const double way : {-share, share}) offer_place(mesh_.point(v) + way * length * normal);
      }
      for (const auto& [x, y] : kDirections)
        offer_place(mesh_.point(v) + share * length * metric.stretched(x * side + y * across));
    }
  }

  // A tangential direction that rotates with the centerline.
  Vec3 towards_neighbour(Vertex v, const Vec3& normal) const {
    const Vec3 edge = mesh_.point(mesh_.source(mesh_.halfedge(v))) - mesh_.point(v);
    const Vec3 along = edge - normal.dot(edge) * normal;
    return along.squaredNorm() > 0 ? Vec3(along.normalized()) : Vec3(normal.unitOrthogonal());
  }

  double worst_around(Vertex v) const { return worst_with(v, v, mesh_.point(v), 1); }

  // With the halfedge of that face that leads to `v`.
  std::pair<double, Halfedge> worst_face_around(Vertex v) const {
    std::pair<double, Halfedge> worst(0, mesh_.halfedge(v));
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const double s = skewness(v, mesh_.target(mesh_.next(h)), mesh_.source(h));
      if (s > worst.first) worst = {s, h};
    }
    return worst;
  }

  // Worst skewness of the faces of `v` not at `other`, with `v` at `place`; may stop at any value of at least `enough`.
  double worst_with(Vertex v, Vertex other, const Vec3& place, double enough) const {
    return worst_with(mesh_.halfedge(v), other, place, enough);
  }
  // Of the target of `first`, whose face is looked at first.
  double worst_with(Halfedge first, Vertex other, const Vec3& place, double enough) const {
    const Vertex v = mesh_.target(first);
    double worst = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(first)) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (other != v && (b == other || c == other)) continue;
      worst = std::max(worst, skewness(v, b, c, place));
      if (worst >= enough) break;
    }
    return worst;
  }

  // The same after the edge ab has collapsed to a vertex.
  double worst_with_both(Vertex a, Vertex b, const Vec3& place, double enough) const {
    const double worst = worst_with(a, b, place, enough);
    return worst >= enough ? worst : std::max(worst, worst_with(b, a, place, enough));
  }

  // Whether flipping ab to cd gives no sharper an edge, or hardly any edge at all.
  bool stays_flat(Vertex a, Vertex b, Vertex c, Vertex d) const {
    const auto normal = [&](Vertex x, Vertex y, Vertex z) {
      return Vec3((mesh_.point(y) - mesh_.point(x)).cross(mesh_.point(z) - mesh_.point(x)).normalized());
    };
    const double before = normal(a, b, c).dot(normal(b, a, d)), after = normal(c, d, b).dot(normal(d, c, a));
    return after >= std::min(before, kFlat);
  }

  // Mean distance from the boundary, at their centres, of the faces around `v` with `v` at `place`.
  double error_around(Vertex v, const Vec3& place) const {
    double area = 0, sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vec3 &b = mesh_.point(mesh_.target(mesh_.next(h))), &c = mesh_.point(mesh_.source(h));
      const double a = (b - place).cross(c - place).norm();
      area += a;
      sum += a * std::abs(surface_.field.sample_fast((place + b + c) / 3, surface_[v].cone).distance);
    }
    return sum / area;
  }

  // Whether the faces around `v`, with `v` at `place`, are near the boundary or hardly farther from it than now.
  bool stays_near(Vertex v, const Vec3& place) {
    const double error = error_around(v, place);
    return error <= kNear * surface_.radius(v) || error <= kFarther * error_around(v);
  }

  // As it is, determined once for all the steps at a face.
  double error_around(Vertex v) {
    const auto known = std::find_if(errors_.begin(), errors_.end(), [v](const auto& e) { return e.first == v; });
    if (known != errors_.end()) return known->second;
    return errors_.emplace_back(v, error_around(v, mesh_.point(v))).second;
  }

  // Where `v` ends up with this lift when moved towards `place`.
  BoundaryPoint belongs(Vertex v, const Vec3& place, double lift) const {
    const Index hint = surface_[v].cone;
    if (keeps_ == Keeps::nothing) return {place, surface_.field.sample(place, hint)};
    return project_to_boundary(surface_.field, place, hint, kTolerance, lift);
  }

  void put(Vertex v, const BoundaryPoint& target) {
    surface_.place(v, target.position, target.sample);
    if (keeps_ == Keeps::nothing) surface_[v].lift = surface_[v].distance;
    note_changed(v);
  }

  // Faces with a corner next to `v` may have different steps now.
  void note_changed(Vertex v) {
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      for (const Face f : mesh_.faces_around_target(mesh_.opposite(h))) changed_.push_back(f);
    }
  }

  // Takes the step unless faces would cross.
  bool take(const Repair& step) {
    switch (step.kind) {
      case Kind::flip:
        if (!surface_.may_flip(step.edge)) return false;
        surface_.flip_edge(step.edge);
        note_changed(mesh_.target(step.edge));
        note_changed(mesh_.source(step.edge));
        return true;
      case Kind::collapse: {
        const Vertex a = mesh_.source(step.edge), b = mesh_.target(step.edge);
        const double lift = 0.5 * (surface_[a].lift + surface_[b].lift);
        const BoundaryPoint target = belongs(a, step.place, lift);
        if (worst_with_both(a, b, target.position, step.before) >= step.before) return false;
        if (!surface_.may_collapse(a, b, target.position)) return false;
        put(surface_.collapse_edge(mesh_.edge(step.edge), target), target);
        return true;
      }
      case Kind::split: {
        if (!surface_.may_split(mesh_.edge(step.edge))) return false;
        const Vertex end = mesh_.target(step.edge);
        put(surface_.split_edge(mesh_.edge(step.edge)), belongs(end, step.place, 0));
        return true;
      }
      case Kind::move:
        break;
    }
    const BoundaryPoint target = belongs(step.vertex, step.place, surface_[step.vertex].lift);
    if (worst_with(step.vertex, step.vertex, target.position, step.before) >= step.before) return false;
    if (keeps_ == Keeps::to_boundary && !stays_near(step.vertex, target.position)) return false;
    if (!surface_.may_place(step.vertex, target.position)) return false;
    put(step.vertex, target);
    return true;
  }
  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  double limit_;
  Keeps keeps_;
  const double pays_off_ = keeps_ == Keeps::to_boundary && surface_.crowded ? kPaysOffInPits : kPaysOff;
  const Progress& progress_;
  std::vector<Face> changed_;                      // in this round
  std::vector<std::pair<Vertex, double>> errors_;  // around vertices of the face at which steps are tried
};

}  // namespace

bool mend_worst_faces(BoundSurface& surface, double limit, const Progress& progress) {
  return Mender(surface, limit, Keeps::nothing, progress).run();
}

void improve_worst_faces(BoundSurface& surface, double limit, const Progress& progress) {
  Mender(surface, limit, Keeps::to_boundary, progress).run();
}

}  // namespace vmesh
