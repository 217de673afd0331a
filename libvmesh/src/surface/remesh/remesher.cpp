#include "surface/remesh/remesher.h"

#include <queue>

#include <CGAL/boost/graph/Euler_operations.h>

namespace vmesh {
namespace {

// In target lengths; safe 1.35 to 1.6, below vertices +6 %, above vertices -7 %.
constexpr double kSplitLength = 1.35;
// In target lengths; safe 0.55 to 0.78, below vertices +14 %, above vertices -6 %.
constexpr double kCollapseLength = 0.65;
constexpr double kSplitFar = 0.8;  // safe 0.56 to 1.1
constexpr double kMaxBulge = 0.3;  // see bulge(); safe 0.21 to 0.42
// In target lengths: shorter edges cannot stray from the boundary; safe 0.35 to 0.7.
constexpr double kCannotStray = 0.5;
constexpr double kUprightFlip = 0.5;   // agreement from which on a flip is always allowed; safe 0.35 to 0.7
constexpr int kLeastValenceGain = -2;  // of a flip that may still pay off; safe -2 to 0
constexpr double kBadEnergy = 1.8;     // of a face: skewness about 0.4; safe 1.3 to 2.5

}  // namespace

void Remesher::split_long_edges() {
  std::priority_queue<std::pair<double, Index>> queue;
  const auto push = [&](Edge e, double limit = std::numeric_limits<double>::infinity()) {
    if (held(e)) return;
    const double excess = state_.length(e) / state_.target_length(e);
    if (excess > kSplitLength && excess < limit && upright(e)) queue.emplace(excess, e.idx());
  };
  for (const Edge e : mesh_.edges()) {
    if (state_.active(e)) push(e);
  }
  while (!queue.empty()) {
    const auto [excess, index] = queue.top();
    queue.pop();
    const Edge e(index);
    if (state_.length(e) / state_.target_length(e) != excess)
      continue;  // outdated: it has changed and was pushed again
    if (!surface_.may_split(e)) continue;
    if (full()) break;
    const Vertex v = split(e);
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      push(mesh_.edge(h), 0.99 * excess);  // ever lower priority, so this ends
      try_flip(mesh_.edge(mesh_.prev(h)), 0);
    }
  }
}

bool Remesher::held(Edge e) const { return surface_.held(mesh_.vertex(e, 0)) && surface_.held(mesh_.vertex(e, 1)); }

bool Remesher::upright(Edge e) const {
  for (const Halfedge h : {mesh_.halfedge(e), mesh_.opposite(mesh_.halfedge(e))}) {
    if (state_.agreement(mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h))) < SweepState::kMinAgreement)
      return false;
  }
  return true;
}

Vertex Remesher::split(Edge e) {
  const Vertex v = surface_.split_edge(e);
  state_.activate(v);
  state_.stir(v);
  move_to_boundary(v);
  return v;
}

void Remesher::move_to_boundary(Vertex v) {
  const BoundaryPoint target = state_.project(v, state_.point(v));
  const Landing landing(target);
  const bool far = (target.position - state_.point(v)).norm() > state_.size(v);
  for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
    const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
    if (far || state_.agreement(landing, b, c) < std::min(SweepState::kMinAgreement, state_.agreement(v, b, c))) {
      surface_.place(v, state_.point(v), field_.sample_fast(state_.point(v), surface_[v].cone));
      return;
    }
  }
  if (surface_.may_place(v, target.position)) {
    surface_.place(v, target.position, target.sample);
  } else {
    surface_.place(v, state_.point(v), field_.sample_fast(state_.point(v), surface_[v].cone));
  }
}

void Remesher::collapse_short_edges() {
  const auto count = static_cast<Index>(mesh_.num_edges());
  for (Index i = 0; i < count; ++i) {
    const Edge e(i);
    if (mesh_.is_removed(e) || !state_.active(e) || state_.length(e) >= kCollapseLength * state_.target_length(e))
      continue;
    collapse(e);
  }
}

bool Remesher::collapse(Edge e) {
  const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
  if (surface_.held(a) || surface_.held(b)) return false;
  const BoundaryPoint target = state_.project_middle(a, b);
  if (!collapsible_to(a, b, target) || !collapsible_to(b, a, target)) return false;
  if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) return false;
  if (!surface_.may_collapse(a, b, target.position)) return false;
  const Vertex v = surface_.collapse_edge(e, target);
  state_.stir(v);
  return true;
}

void Remesher::collapse_bad_faces() {
  const auto count = static_cast<Index>(mesh_.num_faces());
  for (Index i = 0; i < count; ++i) {
    const Face f(i);
    if (mesh_.is_removed(f) || !state_.active(f)) continue;
    const auto [a, b, c] = state_.corners(f);
    if (state_.energy(a, b, c) < kBadEnergy) continue;
    Halfedge shortest = mesh_.halfedge(f);
    for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
      if (state_.length(mesh_.edge(h)) < state_.length(mesh_.edge(shortest))) shortest = h;
    }
    const Vertex u = mesh_.source(shortest), v = mesh_.target(shortest);
    const BoundaryPoint target = state_.project_middle(u, v);
    const double worst = std::max(worst_energy(u, v, target.position), worst_energy(v, u, target.position));
    if (worst < state_.energy(a, b, c)) collapse(mesh_.edge(shortest));
  }
}

double Remesher::worst_energy(Vertex v, Vertex other, const Vec3& p) const {
  double worst = 0;
  for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
    const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
    if (b != other && c != other) worst = std::max(worst, state_.energy(v, b, c, p));
  }
  return worst;
}

bool Remesher::collapsible_to(Vertex v, Vertex other, const BoundaryPoint& target) const {
  const Landing landing(target);
  for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
    const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
    if (b == other || c == other) continue;
    const double reach = state_.length(v, c, target.position);
    const double size = 0.5 * (state_.size(c) + state_.size(v));
    if (reach > kSplitLength * size || !state_.stays_upright(v, b, c, landing)) return false;
    if (reach > kCannotStray * size &&
        std::abs(field_.sample_fast(0.5 * (state_.point(c) + target.position), target.sample.cone).distance) >
            kMaxBulge * reach) {
      return false;
    }
  }
  return true;
}

void Remesher::split_far_faces(double max_distance) {
  const auto count = static_cast<Index>(mesh_.num_faces());
  for (Index i = 0; i < count; ++i) {
    const Face f(i);
    if (mesh_.is_removed(f) || !state_.active(f)) continue;
    const std::array<Vertex, 3> corner = state_.corners(f);
    if (std::count_if(corner.begin(), corner.end(), [&](Vertex v) { return surface_.held(v); }) > 1) continue;
    const Vec3 center = (state_.point(corner[0]) + state_.point(corner[1]) + state_.point(corner[2])) / 3;
    const FieldSample s = field_.sample_fast(center, surface_[corner[0]].cone);
    if (std::abs(s.distance) <= max_distance * field_.relations().radius_at(s.cone, s.t)) continue;
    double longest = 0, target = 0;
    for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
      longest = std::max(longest, state_.length(mesh_.edge(h)));
      target = std::max(target, state_.target_length(mesh_.edge(h)));
    }
    if (longest < kSplitFar * target) continue;  // a web over a crotch: refinement would not bring it closer
    if (!surface_.may_split_edge_centric(f)) continue;
    if (full()) break;
    for (const Vertex v : surface_.split_edge_centric(f)) {
      surface_[v].size = std::min({state_.size(corner[0]), state_.size(corner[1]), state_.size(corner[2])}) / 2;
      state_.activate(v);
      state_.stir(v);
      move_to_boundary(v);
    }
  }
}

double Remesher::bulge(Vertex a, Vertex b) const {
  const Vec3 middle = 0.5 * (state_.point(a) + state_.point(b));
  return std::abs(field_.sample_fast(middle, surface_[a].cone).distance) / state_.length(a, b, state_.point(a));
}

void Remesher::repair_strays() {
  const auto count = static_cast<Index>(mesh_.num_edges());
  for (Index i = 0; i < count; ++i) {
    const Edge e(i);
    if (mesh_.is_removed(e) || !state_.active(e) || state_.length(e) < kCannotStray * state_.target_length(e)) continue;
    const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
    const double stray = bulge(a, b);
    if (stray < kMaxBulge) continue;
    const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (can_flip(h) && bulge(c, d) < 0.5 * stray && flip_stays_upright(a, b, c, d) && surface_.may_flip(h)) {
      flip(h);
    }
  }
}

bool Remesher::can_flip(Halfedge h) const {
  const Halfedge o = mesh_.opposite(h);
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  if (held(mesh_.edge(h)) || (surface_.held(c) && surface_.held(d))) return false;
  if (mesh_.degree(mesh_.source(h)) <= 3 || mesh_.degree(mesh_.target(h)) <= 3) return false;
  return mesh_.halfedge(c, d) == SurfaceMesh::null_halfedge();
}

bool Remesher::flip_stays_upright(Vertex a, Vertex b, Vertex c, Vertex d) const {
  const double then = std::min(state_.agreement(c, d, b), state_.agreement(d, c, a));
  return then >= kUprightFlip || then >= std::min(state_.agreement(a, b, c), state_.agreement(b, a, d));
}

int Remesher::valence_gain(Vertex a, Vertex b, Vertex c, Vertex d) const {
  const auto valence = [&](Vertex v) { return static_cast<int>(mesh_.degree(v)) + surface_.held(v); };  // by a lid
  return 2 * (valence(a) + valence(b) - valence(c) - valence(d)) - 4;
}

void Remesher::flip_edges(double regularity) {
  for (const Edge e : mesh_.edges()) {
    if (state_.active(e)) try_flip(e, regularity);
  }
}

void Remesher::flip(Halfedge h) {
  for (const Halfedge side : {h, mesh_.opposite(h)}) {
    state_.touch(mesh_.target(side));
    state_.touch(mesh_.target(mesh_.next(side)));
  }
  surface_.flip_edge(h);
}

bool Remesher::try_flip(Edge e, double regularity) {
  const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
  const Vertex a = mesh_.source(h), b = mesh_.target(h);
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  double gain = state_.energy(a, b, c) + state_.energy(b, a, d) - state_.energy(c, d, b) - state_.energy(d, c, a);
  if (regularity > 0) gain += regularity * valence_gain(a, b, c, d);
  if (!(gain > 1e-9)) return false;
  return flip_if_upright(h, a, b, c, d);
}

bool Remesher::flip_with_foresight(Edge e) {
  const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
  const Vertex a = mesh_.source(h), b = mesh_.target(h);
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  return valence_gain(a, b, c, d) >= kLeastValenceGain && flip_if_upright(h, a, b, c, d);
}

bool Remesher::flip_if_upright(Halfedge h, Vertex a, Vertex b, Vertex c, Vertex d) {
  if (!can_flip(h) || !flip_stays_upright(a, b, c, d)) return false;
  const double stray = bulge(c, d);
  if (stray > kMaxBulge && stray > bulge(a, b)) return false;
  if (!surface_.may_flip(h)) return false;
  flip(h);
  return true;
}

}  // namespace vmesh
