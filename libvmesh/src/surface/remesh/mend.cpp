#include "surface/remesh/mend.h"

#include <algorithm>
#include <array>
#include <optional>

#include <CGAL/boost/graph/Euler_operations.h>

#include "vmesh/mesh/triangle_quality.h"

namespace vmesh {
namespace {

constexpr int kRounds = 20;         // through all bad faces; idle 14 to 28
constexpr double kPaysOff = 0.998;  // worst skewness around against that before; safe 0.7 to 1.4

constexpr double kMostOffBoundary = 0.15;  // edge lengths that one step may lead from it; safe 0.1 to 0.21
constexpr double kDiagonal = 0.70710678118654752;
constexpr std::array<std::array<double, 2>, 8> kDirections = {{{1, 0},
                                                               {kDiagonal, kDiagonal},
                                                               {0, 1},
                                                               {-kDiagonal, kDiagonal},
                                                               {-1, 0},
                                                               {-kDiagonal, -kDiagonal},
                                                               {0, -1},
                                                               {kDiagonal, -kDiagonal}}};

// Applies to one face after the other the step that helps most.
class Mender {
 public:
  Mender(BoundSurface& surface, double limit) : surface_(surface), mesh_(surface.mesh), limit_(limit) {}

  bool run() {
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Face> bad = bad_faces();
      if (bad.empty()) return round > 0;
      if (round == 0) surface_.guard_crossings();
      bool any = false;
      for (const Face f : bad) any = (!mesh_.is_removed(f) && skewness(f) > limit_ && mend(f)) || any;
      if (!any) break;
    }
    return true;
  }

 private:
  enum class Kind { flip, collapse, split, move };
  struct Step {
    Kind kind;
    Halfedge edge;  // of a flip, collapse or split
    Vertex vertex;  // of a move
    Vec3 place;
    double worst;  // skewness around, afterwards
  };

  std::vector<Face> bad_faces() const {
    std::vector<std::pair<double, Face>> order;
    for (const Face f : mesh_.faces()) {
      if (surface_.is_lid(f)) continue;
      const double s = skewness(f);
      if (s > limit_) order.emplace_back(-s, f);
    }
    std::sort(order.begin(), order.end());
    std::vector<Face> faces;
    for (const auto& [_, f] : order) faces.push_back(f);
    return faces;
  }

  double skewness(Face f) const {
    const Halfedge h = mesh_.halfedge(f);
    return equiangle_skewness(mesh_.point(mesh_.source(h)), mesh_.point(mesh_.target(h)),
                              mesh_.point(mesh_.target(mesh_.next(h))));
  }

  bool mend(Face f) {
    std::vector<Step> steps;
    for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
      add_flip(h, steps);
      add_collapses(h, steps);
      add_split(h, steps);
      add_moves(mesh_.target(h), steps);
    }
    std::stable_sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.worst < b.worst; });
    return std::any_of(steps.begin(), steps.end(), [&](const Step& step) { return take(step); });
  }

  bool any_is_lid(std::initializer_list<Vertex> vertices) const {
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](Vertex v) { return surface_.role[v] == BoundSurface::Role::lid; });
  }

  // A step is offered if it lowers the worst skewness of the faces it changes.
  void offer(const Step& step, double before, std::vector<Step>& steps) const {
    if (step.worst < kPaysOff * before) steps.push_back(step);
  }

  void add_flip(Halfedge h, std::vector<Step>& steps) const {
    const Halfedge o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (any_is_lid({a, b, c, d})) return;
    if ((surface_.held(a) && surface_.held(b)) || (surface_.held(c) && surface_.held(d))) return;
    if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge()) return;
    const double worst = std::max(equiangle_skewness(mesh_.point(c), mesh_.point(d), mesh_.point(b)),
                                  equiangle_skewness(mesh_.point(d), mesh_.point(c), mesh_.point(a)));
    offer({Kind::flip, h, {}, Vec3::Zero(), worst}, std::max(skewness(mesh_.face(h)), skewness(mesh_.face(o))), steps);
  }

  void add_collapses(Halfedge h, std::vector<Step>& steps) const {
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    if (surface_.held(a) || surface_.held(b)) return;
    if (!CGAL::Euler::does_satisfy_link_condition(mesh_.edge(h), mesh_)) return;
    const double before = std::max(worst_around(a), worst_around(b));
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vec3 place = (1 - t) * mesh_.point(a) + t * mesh_.point(b);
      offer({Kind::collapse, h, {}, place, std::max(worst_with(a, b, place), worst_with(b, a, place))}, before, steps);
    }
  }

  // In the middle; faces stay where they are.
  void add_split(Halfedge h, std::vector<Step>& steps) const {
    const Halfedge o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (any_is_lid({a, b, c, d})) return;
    if (surface_.held(a) && surface_.held(b)) return;
    const Vec3 middle = 0.5 * (mesh_.point(a) + mesh_.point(b));
    double worst = 0;
    for (const Vertex apex : {c, d}) {
      for (const Vertex end : {a, b})
        worst = std::max(worst, equiangle_skewness(mesh_.point(apex), mesh_.point(end), middle));
    }
    offer({Kind::split, h, {}, middle, worst}, std::max(skewness(mesh_.face(h)), skewness(mesh_.face(o))), steps);
  }

  // To the neighbours' centre and around where it is, nearer and nearer.
  void add_moves(Vertex v, std::vector<Step>& steps) const {
    if (surface_.held(v)) return;
    Vec3 center = Vec3::Zero();
    double length = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      center += mesh_.point(mesh_.source(h));
      length += (mesh_.point(mesh_.source(h)) - mesh_.point(v)).norm();
    }
    center /= static_cast<double>(mesh_.degree(v));
    length /= static_cast<double>(mesh_.degree(v));
    const double before = worst_around(v);
    const auto offer_place = [&](const Vec3& place) {
      offer({Kind::move, {}, v, place, worst_with(v, v, place)}, before, steps);
    };
    for (const double share : {0.25, 0.5, 1.0}) offer_place(mesh_.point(v) + share * (center - mesh_.point(v)));
    const Vec3 normal = surface_.gradient[v], side = normal.unitOrthogonal(), across = normal.cross(side);
    for (const double share : {0.6, 0.4, 0.2, 0.1, 0.05, 0.02}) {
      if (share < kMostOffBoundary) {
        for (const double way : {-share, share}) offer_place(mesh_.point(v) + way * length * normal);
      }
      for (const auto& [x, y] : kDirections) offer_place(mesh_.point(v) + share * length * (x * side + y * across));
    }
  }

  double worst_around(Vertex v) const { return worst_with(v, v, mesh_.point(v)); }

  // Of the faces of `v` but those at `other`, once it is at `place`.
  double worst_with(Vertex v, Vertex other, const Vec3& place) const {
    double worst = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (other != v && (b == other || c == other)) continue;
      worst = std::max(worst, equiangle_skewness(place, mesh_.point(b), mesh_.point(c)));
    }
    return worst;
  }

  // Unless faces would cross.
  bool take(const Step& step) {
    switch (step.kind) {
      case Kind::flip:
        if (!surface_.may_flip(step.edge)) return false;
        CGAL::Euler::flip_edge(step.edge, mesh_);
        surface_.touch_faces(mesh_.target(step.edge));
        return true;
      case Kind::collapse: {
        const Vertex a = mesh_.source(step.edge), b = mesh_.target(step.edge);
        if (!surface_.may_collapse(a, b, step.place)) return false;
        const Index hint = surface_.cone[a];
        put(CGAL::Euler::collapse_edge(mesh_.edge(step.edge), mesh_), step.place, hint);
        return true;
      }
      case Kind::split: {
        const Index hint = surface_.cone[mesh_.target(step.edge)];
        put(surface_.split_edge(mesh_.edge(step.edge)), step.place, hint);
        return true;
      }
      case Kind::move:
        break;
    }
    if (!surface_.may_place(step.vertex, step.place)) return false;
    put(step.vertex, step.place, surface_.cone[step.vertex]);
    return true;
  }

  void put(Vertex v, const Vec3& place, Index hint) {
    surface_.place(v, place, surface_.field.sample(place, hint));
    surface_.lift[v] = surface_.distance[v];
  }

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  double limit_;
};

}  // namespace

bool mend_worst_faces(BoundSurface& surface, double limit) { return Mender(surface, limit).run(); }

}  // namespace vmesh
