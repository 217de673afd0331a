#include "surface/proof/refined_surface.h"

#include <Eigen/LU>

#include "vmesh/core/ascending.h"
#include "vmesh/mesh/triangle_energy.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/soundness.h"

#include "surface/remesh/edge_lengths.h"

namespace vmesh {
namespace {

constexpr int kImprovements = 3;     // passes of flips and moves after splits
constexpr double kLeastGain = 1e-3;  // of skewness
// Relative gain of energy, and share of the most of a change of height, that are worth a move and the proofs after it;
// at creases, where the triangles that are proven are hard to find, smaller ones are.
constexpr double kRounder = 0.03, kRounderAtCreases = 1e-3;
constexpr double kWorthALift = 0.2, kWorthALiftAtCreases = 0.05;
constexpr double kWorthATry = 0.5;    // of what is worth a move: as much is expected
constexpr double kLongestMove = 0.3;  // in edges
constexpr double kRound = 0.5;        // skewness up to which triangles may become worse for the sake of balance

double skewness(const PlacedFace& f) { return equiangle_skewness(f.points[0], f.points[1], f.points[2]); }

struct BestWay {
  Vec3 way = Vec3::Zero();
  double gain = 0;  // relative, of energy, as far as two derivatives tell
};

// One Newton step, no longer than `longest`.
BestWay best_way(const PlanarEnergy& shape, const Vec3& u, const Vec3& w, double longest) {
  if (!std::isfinite(shape.value)) return {};
  const Eigen::Vector2d step = -shape.hessian.inverse() * shape.gradient;
  const double length = step.norm();
  if (!std::isfinite(length)) return {};
  const double share = std::min(1.0, longest / length);
  return {share * (step.x() * u + step.y() * w), -share * (1 - share / 2) * shape.gradient.dot(step) / shape.value};
}

}  // namespace

RefinedSurface::RefinedSurface(const FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal)
    : mesh(finished_mesh(surface)),
      edit(mesh),
      held(mesh.vertices().size(), 0),
      crease_at(mesh.vertices().size()),
      at_kink(mesh.vertices().size(), 0),
      has_creases(field.relations().blend() == 0),
      field_(field),
      goal_(goal),
      way_(refinement_way(goal.way)) {
  for (const Opening& opening : surface.openings) {
    for (const Index v : opening.ring) held[v] = 1;
  }
  for (const Index v : surface.held) held[v] = 1;
}

Index RefinedSurface::take(const std::vector<Step>& steps, double worst) {
  const Index placed = edit.take_best(steps, worst);
  if (placed == kNone) return placed;
  note_faces_around(placed);
  return placed;
}

void RefinedSurface::note_faces_around(Index v) {
  held.resize(mesh.vertices().size(), 0);
  crease_at.resize(mesh.vertices().size());
  at_kink.resize(mesh.vertices().size(), 0);
  const auto& fan = mesh.faces_around(v);
  changed.insert(changed.end(), fan.begin(), fan.end());
}

double RefinedSurface::worst_skewness(const Step& step) const {
  double worst = 0;
  for (const Triangle& f : step.faces) worst = std::max(worst, skewness(mesh.placed(f, step)));
  return worst;
}
double RefinedSurface::worst_now(const Step& step) const {
  double worst = 0;
  for (const Index f : step.gone) worst = std::max(worst, skewness(mesh.placed(f)));
  return worst;
}

void RefinedSurface::improve(std::vector<Index>& due) {
  std::vector<Index> faces = changed;
  for (int pass = 0; pass < kImprovements && !faces.empty(); ++pass) {
    sort_unique(faces);
    due.insert(due.end(), faces.begin(), faces.end());
    changed.clear();
    for (const MeshEdge& e : edges_of(faces)) flip(e);
    std::vector<Index> vertices;
    for (const Index f : faces) {
      if (mesh.has_face(f)) vertices.insert(vertices.end(), mesh.faces()[f].begin(), mesh.faces()[f].end());
    }
    sort_unique(vertices);
    for (const Index v : vertices) move(v);
    faces = changed;
  }
  due.insert(due.end(), faces.begin(), faces.end());
  sort_unique(due);
}

// Of those of the faces that are there, each once.
std::vector<MeshEdge> RefinedSurface::edges_of(const std::vector<Index>& faces) const {
  std::vector<MeshEdge> edges;
  for (const Index f : faces) {
    if (!mesh.has_face(f)) continue;
    for (const MeshEdge& e : edges_of(mesh.faces()[f])) edges.push_back({std::min(e.a, e.b), std::max(e.a, e.b)});
  }
  sort_unique(edges);
  return edges;
}

void RefinedSurface::flip(const MeshEdge& e) {
  if (!mesh.is_inner(e) || !mesh.may_flip(e)) return;
  const Step step = mesh.flipping(e);
  const auto [c, d] = mesh.opposite(e);
  const double now = worst_now(step), then = worst_skewness(step), off_now = off_at(e);
  const bool may_be_nearer = off_now > kWorthAProof && then < kWorstSkewness, may_be_better = then < now - kLeastGain;
  const bool may_be_regular = then < kRound && irregularity_after(e, c, d) < 0;
  if (!(may_be_nearer || may_be_better || may_be_regular)) return;
  const double off_then = off_at({c, d});
  const bool is_nearer = may_be_nearer && off_then < 0.7 * off_now;
  const bool is_better = may_be_better && off_then < std::max(off_now, 0.7 * kWorthAProof);
  const bool is_regular = may_be_regular && off_then < kWorthAProof * 0.9;
  if ((is_nearer || is_better || is_regular) && stays_upright(step, way_.upright)) take({step}, kWorstSkewness);
}

// How the squares of the differences from six edges at a vertex change by a flip.
int RefinedSurface::irregularity_after(const MeshEdge& e, Index c, Index d) const {
  const auto change = [&](Index v, int by) {
    const int difference = static_cast<int>(mesh.faces_around(v).size()) - 6;
    return (difference + by) * (difference + by) - difference * difference;
  };
  return change(e.a, -1) + change(e.b, -1) + change(c, 1) + change(d, 1);
}

double RefinedSurface::energy(const Step& step) const {
  double sum = 0;
  for (const Triangle& f : step.faces) {
    const PlacedFace face = mesh.placed(f, step);
    sum += squared_inverse_mean_ratio(face.points[0], face.points[1], face.points[2]);
  }
  return sum;
}

bool RefinedSurface::stays_upright(const Step& step, double least) const {
  return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& f) {
    const PlacedFace face = mesh.placed(f, step);
    const Vec3 normal = (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]);
    const Vec3 center = (face.points[0] + face.points[1] + face.points[2]) / 3;
    const Vec3 gradient =
        rough_sample(center, step.vertex == kNone ? cone(f[0]) : step.target.binding.segment).gradient;
    return normal.dot(gradient) > least * normal.norm() * gradient.norm();
  });
}

// To where its triangles have the best shape, as high as balances them.
void RefinedSurface::move(Index v) {
  if (!mesh.has_vertex(v) || held[v] || at_kink[v]) return;
  double area = 0, sum = 0;
  const double height = lift_of(v);
  PlanarEnergy shape;
  const Vec3 normal = mesh.vertex_normal(v), u = normal.unitOrthogonal(), w = normal.cross(u);
  for (const Index f : mesh.faces_around(v)) {
    const Triangle face = FinishedMesh::turned_to(v, mesh.faces()[f]);
    const Vec3 &a = point(v), &b = point(face[1]), &c = point(face[2]);
    const double weight = (b - a).cross(c - a).norm();
    const double at_center = distance_by_slope(rough_sample((a + b + c) / 3, cone(v)));
    sum += weight * (0.75 * at_center + 0.25 * height);
    area += weight;
    shape.add(a, b, c, u, w);
  }
  const double most = kShareOfLimit * limit_at(v);
  const double lift = is_balanced() ? std::clamp(height - sum / area, -most, most) : 0;
  const bool at_crease = is_at_crease(v);
  const double rounder = at_crease ? kRounderAtCreases : kRounder;
  const double worth_a_lift = at_crease ? kWorthALiftAtCreases : kWorthALift;
  const bool is_lifted = !crease_at[v] && std::abs(lift - height) > worth_a_lift * most;
  const bool may_be_lower = crease_at[v] && height > most;
  const auto [way, gain] = best_way(shape, u, w, kLongestMove * mesh.mean_edge(v));
  if (gain < kWorthATry * rounder && !is_lifted && !may_be_lower) return;
  const double off_now = off_around(v);
  for (const double share : {1.0, 0.5, 0.0}) {
    const Vec3 p = point(v) + share * way;
    const auto on_crease = crease_at[v] ? onto_crease(field_, *crease_at[v], p, limit_at(v)) : std::nullopt;
    if (crease_at[v] && !on_crease) continue;
    const BoundaryPoint target = on_crease ? towards(*on_crease, p, mesh.mean_edge(v))
                                           : onto_boundary(field_, p, cone(v), kRefinedTolerance, lift);
    const bool is_lower = may_be_lower && distance_by_slope(target.sample) < 0.9 * height;
    const Step step = mesh.moving(v, finished_vertex(target, field_));
    const double worst = std::max(worst_now(step), kRound);
    const bool is_rounder = energy(step) < (1 - rounder) * shape.value;
    if (!(is_rounder || is_lifted || is_lower) || worst_skewness(step) > worst || !stays_upright(step, way_.upright))
      continue;
    if (off_around(v, target.position) > std::max(kWorthAProof * 0.9, off_now)) continue;
    if (take({step}, worst) != kNone) break;
  }
}

// Whether a vertex or one beside it is on a crease.
bool RefinedSurface::is_at_crease(Index v) const {
  const auto& fan = mesh.faces_around(v);
  return has_creases && std::any_of(fan.begin(), fan.end(), [&](Index f) {
           const Triangle& face = mesh.faces()[f];
           return std::any_of(face.begin(), face.end(), [&](Index w) { return crease_at[w].has_value(); });
         });
}

double RefinedSurface::off_around(Index v, const Vec3& p) const {
  double worst = 0;
  for (const Index f : mesh.faces_around(v)) {
    Vec3 center = p / 3;
    for (const Index w : mesh.faces()[f]) {
      if (w == v) continue;
      center += point(w) / 3;
      worst = std::max(worst, off_at(0.5 * (p + point(w)), cone(w)));
    }
    worst = std::max(worst, off_at(center, cone(v)));
  }
  return worst / limit_at(v);
}

}  // namespace vmesh
