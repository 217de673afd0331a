#include "surface/remesh/balance.h"

#include <vector>

namespace vmesh {
namespace {

// In target lengths; a sphere with six vertices around needs 0.13; safe 0.1 to 0.21.
constexpr double kMostLift = 0.15;
// Mean signed distance around a vertex that may remain, relative to what edges cut off: 0.003 radii at six around, 1e-5
// at 96. With an error limit, in radii: where triangles are small they are to be proven, and moving on costs proofs
// (with the first, --max-error 10% --blend 0 is not proven on tree119). The second: safe 0.0021 to 0.0042.
constexpr double kBalanced = 0.02, kBalancedWithLimit = 0.003;
// Share of the gap to another vessel into which a vertex may be lifted; safe 0.24 to 0.49.
constexpr double kShareOfGap = 0.35;
// All the way, or half as far as the one before. Measured on tree1560 at 96 around, blend .5: with one attempt and
// without the neighbours' centroid (SweepState::project), a vertex near a saddle of the field is .008 radii off. Not
// varied.
constexpr int kAttemptsToMove = 12;

// Area of every face and signed distance at its centroid.
struct FaceErrors {
  std::vector<double> area, at_center;
};

FaceErrors face_errors(const SweepState& state) {
  const BoundSurface& surface = state.surface;
  FaceErrors errors;
  errors.area.resize(state.mesh.num_faces());
  errors.at_center.resize(state.mesh.num_faces());
  for (const Face f : state.mesh.faces()) {
    if (surface.is_lid(f)) continue;
    const auto [a, b, c] = state.corners(f);
    const Vec3 center = (state.point(a) + state.point(b) + state.point(c)) / 3;
    errors.at_center[f.idx()] = state.field.sample_fast(center, surface[a].cone).distance;
    errors.area[f.idx()] = surface.face_area_normal(f).norm();
  }
  return errors;
}

// Walls that come close must not meet.
double most_outwards(const SweepState& state, Vertex v, double most) {
  const BoundSurface& surface = state.surface;
  const Vec3 on_boundary = state.point(v) - surface[v].distance * surface[v].gradient;
  const double gap = state.field.distance_to_others(on_boundary, surface[v].cone, most / kShareOfGap);
  return kShareOfGap * std::max(0.0, gap);
}

// The largest along its edges, 1/mm.
double valley_curvature(const BoundSurface& surface, Vertex v) {
  double most = 0;
  for (const Halfedge h : surface.mesh.halfedges_around_target(surface.mesh.halfedge(v)))
    most = std::max(most, surface.valley_curvature(v, surface.mesh.source(h)));
  return most;
}

void update_lifts(SweepState& state, const ErrorLimit& limit) {
  const FaceErrors errors = face_errors(state);
  const bool rounded = state.field.relations().blend() > 0 && !limit.is_set();  // valleys have a curvature
  for (const Vertex v : state.mesh.vertices()) {
    if (state.surface.held(v)) continue;
    double area = 0, sum = 0;
    for (const Face f : state.mesh.faces_around_target(state.mesh.halfedge(v))) {
      area += errors.area[f.idx()];
      sum += errors.area[f.idx()] * (0.75 * errors.at_center[f.idx()] + 0.25 * state.surface[v].distance);
    }
    const double radius = state.surface.radius(v), size = state.size(v);
    const double balanced = limit.is_set() ? kBalancedWithLimit * radius : kBalanced * cut_off(size, radius);
    if (std::abs(sum) <= balanced * area) continue;
    const double highest = std::min(limit.at(radius), state.surface.refined_to.at(radius));
    const auto most = [&](double curvature) {
      return std::min(kMostLift * size * std::min(1.0, size * curvature), kShareOfLimit * highest);
    };
    const double out = most(1 / radius),
                 in = rounded ? most(std::max(1 / radius, valley_curvature(state.surface, v))) : out;
    state.surface[v].lift = std::clamp(state.surface[v].lift - sum / area, -in, most_outwards(state, v, out));
  }
}

bool may_move(const SweepState& state, Vertex v, const BoundaryPoint& target) {
  if ((target.position - state.point(v)).norm() > state.size(v)) return false;
  const Landing landing(target);
  for (const Halfedge h : state.mesh.halfedges_around_target(state.mesh.halfedge(v))) {
    if (!state.stays_upright(v, state.mesh.target(state.mesh.next(h)), state.mesh.source(h), landing)) return false;
  }
  return state.surface.may_place(v, target.position);
}

// As far towards `target` as may be: where faces would turn too far, in several steps.
void move_towards(SweepState& state, Vertex v, const BoundaryPoint& target) {
  double share = 1;
  for (int attempt = 0; attempt < kAttemptsToMove; ++attempt) {
    BoundaryPoint place = target;
    if (share < 1) {
      place.position = state.point(v) + share * (target.position - state.point(v));
      place.sample = state.field.sample_fast(place.position, target.sample.cone);
    }
    const bool moves = may_move(state, v, place);
    if (moves) state.surface.place(v, place.position, place.sample);
    if (moves && share == 1) return;
    share = moves ? 1 : share / 2;
  }
}

}  // namespace

void balance(SweepState& state, const ErrorLimit& limit) {
  std::vector<char> strays(state.mesh.num_vertices());
  for (const Vertex v : state.mesh.vertices()) strays[v.idx()] = state.off_boundary(v);
  update_lifts(state, limit);
  for (const Vertex v : state.mesh.vertices()) {
    if (state.surface.held(v) || strays[v.idx()]) continue;
    move_towards(state, v, state.project(v));
    state.surface[v].lift = state.surface[v].distance;
  }
}

void return_to_boundary(SweepState& state) {
  for (const Vertex v : state.mesh.vertices()) {
    const double off = std::abs(state.surface[v].distance - state.surface[v].lift);
    if (state.surface.held(v) || off <= arrival_tolerance(state.surface, v) * state.surface.radius(v)) continue;
    move_towards(state, v, state.project(v));
    state.stir(v);
  }
}

void drop_lifts(SweepState& state, const std::vector<Vertex>& vertices) {
  const auto drop_lift = [&state](Vertex v) {
    if (state.surface.held(v) || state.surface[v].lift <= 0) return;
    state.surface[v].lift = 0;
    const BoundaryPoint target = state.project(v);
    if (may_move(state, v, target)) state.surface.place(v, target.position, target.sample);
  };
  for (const Vertex v : vertices) {
    drop_lift(v);
    for (const Halfedge h : state.mesh.halfedges_around_target(state.mesh.halfedge(v))) drop_lift(state.mesh.source(h));
  }
}

}  // namespace vmesh
