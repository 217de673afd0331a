#include "surface/proof/refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <tbb/parallel_for.h>

#include "vmesh/edit/guarded_edit.h"
#include "vmesh/mesh/triangle_energy.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/error_bound.h"
#include "vmesh/surface/soundness.h"

#include "surface/check/error_limit.h"
#include "surface/proof/by_slope.h"
#include "surface/proof/crease.h"
#include "surface/proof/furrows.h"
#include "surface/proof/gap.h"
#include "surface/proof/refined_proof.h"
#include "surface/remesh/edge_lengths.h"

namespace vmesh {
namespace {

// Of the limit: what is farther at the middle of an edge or a face is not worth a proof.
constexpr double kWorthAProof = 0.97;
// Rounds in which no area is proven.
constexpr int kPatience = 6;
constexpr int kMostSplitRounds = 12;  // each halves edges
constexpr int kImprovements = 3;      // passes of flips and moves after splits
constexpr double kTolerance = 1e-3;   // radii, of vertices on the boundary
constexpr double kLeastGain = 1e-3;   // of skewness
// Relative gain of energy, and share of the most of a change of height, that are worth a move and the proofs after it;
// at creases, where the triangles that are proven are hard to find, smaller ones are.
constexpr double kRounder = 0.03, kRounderAtCreases = 1e-3;
constexpr double kWorthALift = 0.2, kWorthALiftAtCreases = 0.05;
constexpr double kLongestMove = 0.3;  // in edges
constexpr double kRound = 0.5;        // skewness up to which triangles may become worse for the sake of balance
constexpr double kNearEnd = 0.2;  // share of an edge from its end within which its end is moved onto a crease instead
constexpr double kSlides[] = {0.5, 0.4, 0.6};  // where edges are divided

class Refinement {
 public:
  Refinement(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
             const std::vector<HardPlace>& hard, const Progress& progress)
      : surface_(surface),
        field_(field),
        goal_(goal),
        hard_(hard),
        progress_(progress),
        proof_(field),
        gaps_(field),
        mesh_(finished_mesh(surface)),
        edit_(mesh_) {
    held_.assign(mesh_.vertices().size(), 0);
    crease_at_.resize(mesh_.vertices().size());
    for (const Opening& opening : surface.openings) {
      for (const Index v : opening.ring) held_[v] = 1;
    }
    for (Index f = 0; f < mesh_.faces().size(); ++f) due_.push_back(f);
  }

  std::vector<Index> run() {
    bring_strays_back();
    go_down_into_gaps(due_);
    for (int round = 0; round < kMostSplitRounds && split_where_far(); ++round) improve();
    prove();
    const double at_first = unproven_area();
    double least = at_first;
    std::vector<Index> best = unproven_;
    std::optional<FinishedMesh::Transaction> since_best;
    since_best.emplace(mesh_);
    for (int round = 0, last = 0; !unproven_.empty() && round < last + kPatience; ++round) {
      report_progress(progress_, "refine", 1 - least / at_first);
      go_down_into_gaps(unproven_);
      if (!split_unproven()) break;
      improve();
      prove();
      if (unproven_area() >= least) continue;
      least = unproven_area();
      best = unproven_;
      last = round + 1;
      since_best->keep();
      since_best.emplace(mesh_);
    }
    since_best.reset();
    return finish(best);
  }

 private:
  using Step = FinishedMesh::Step;

  const Vec3& point(Index v) const { return mesh_.position(v); }
  Index cone(Index v) const { return mesh_.vertex(v).binding.segment; }
  double limit_at(Index v) const {
    const double radius = mesh_.vertex(v).radius;
    return std::min(goal_.limit.at(radius), kHighestShell * radius);
  }
  double limit_of(const MeshEdge& e) const { return std::min(limit_at(e.a), limit_at(e.b)); }
  double limit_of(const Triangle& f) const { return std::min({limit_at(f[0]), limit_at(f[1]), limit_at(f[2])}); }
  double length(const MeshEdge& e) const { return (point(e.a) - point(e.b)).norm(); }
  static std::array<MeshEdge, 3> edges_of(const Triangle& f) {
    return {MeshEdge{f[0], f[1]}, MeshEdge{f[1], f[2]}, MeshEdge{f[2], f[0]}};
  }

  // Decides what is tried, not what is proven: single precision will do. Not at creases, where the cones of two walls
  // are equally near, and which of them is taken decides how much is tried in vain.
  FieldSample rough_sample(const Vec3& p, Index hint) const {
    return has_creases_ ? field_.sample(p, hint) : field_.sample_fast(p, hint);
  }

  // How far a point is off the boundary, mm.
  double off_at(const Vec3& p, Index hint) const { return std::abs(distance_by_slope(rough_sample(p, hint))); }
  // At the middle of an edge, by its limit.
  double off_at(const MeshEdge& e) const { return off_at(0.5 * (point(e.a) + point(e.b)), cone(e.a)) / limit_of(e); }
  double off_at_center(const Triangle& f) const {
    const Vec3 center = (point(f[0]) + point(f[1]) + point(f[2])) / 3;
    return off_at(center, cone(f[0])) / limit_of(f);
  }

  double unproven_area() const {
    double area = 0;
    for (const Index f : unproven_) area += mesh_.area_normal(f).norm() / 2;
    return area;
  }

  bool may_split(const MeshEdge& e) const {
    if (!mesh_.is_inner(e) || (held_[e.a] && held_[e.b])) return false;
    const double radius = std::min(mesh_.vertex(e.a).radius, mesh_.vertex(e.b).radius);
    return length(e) > way_around(hard_, middle_of(e)).shortest * std::sqrt(limit_of(e) * radius);
  }

  bool is_at_opening(Index f) const {
    const auto& [a, b, c] = mesh_.faces()[f];
    return held_[a] || held_[b] || held_[c];
  }

  // What is worst among the edges of a face, or its longest edge if its middle is worst.
  struct Candidate {
    double off = 0;
    MeshEdge edge;
  };
  Candidate worst_of(Index f) const {
    const Triangle& face = mesh_.faces()[f];
    Candidate worst;
    MeshEdge longest = {face[0], face[1]};
    for (const MeshEdge& e : edges_of(face)) {
      if (length(e) > length(longest)) longest = e;
      const double off = off_at(e);
      if (off > worst.off) worst = {off, e};
    }
    const double center = off_at_center(face);
    if (center > worst.off) worst = {center, longest};
    return worst;
  }

  // Whether a face is known to be beyond the limit: the boundary is nowhere nearer than the distance tells.
  bool is_far(Index f) const {
    const Triangle& face = mesh_.faces()[f];
    const auto [a, b, c] = mesh_.corners(f);
    const std::array<Vec3, 4> middles = {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3};
    return std::any_of(middles.begin(), middles.end(), [&](const Vec3& p) {
      return std::abs(rough_sample(p, cone(face[0])).distance) > limit_of(face);
    });
  }

  bool split_where_far() {
    std::vector<Candidate> candidates(due_.size());
    tbb::parallel_for(std::size_t{0}, due_.size(), [&](std::size_t i) {
      if (mesh_.has_face(due_[i]) && !is_at_opening(due_[i])) candidates[i] = worst_of(due_[i]);
    });
    due_.clear();
    std::erase_if(candidates, [](const Candidate& c) { return c.off <= kWorthAProof; });
    return split(std::move(candidates));
  }

  bool split_unproven() {
    std::vector<Candidate> candidates;
    for (const Index f : unproven_) {
      if (!mesh_.has_face(f)) continue;
      Candidate c = worst_of(f);
      // Nothing is far; long edges make proofs hard.
      if (c.off <= kWorthAProof) {
        for (const MeshEdge& e : edges_of(mesh_.faces()[f])) {
          if (length(e) > length(c.edge)) c.edge = e;
        }
      }
      candidates.push_back(c);
    }
    return split(std::move(candidates));
  }

  // Farthest first.
  bool split(std::vector<Candidate> candidates) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.off > b.off; });
    changed_.clear();
    for (const Candidate& c : candidates) {
      if (mesh_.vertices().size() >= goal_.most_vertices) break;
      if (!may_split(c.edge)) continue;
      divide(c.edge);
    }
    return !changed_.empty();
  }

  struct CreasePoint {
    Crease crease;
    BoundaryPoint at;
  };

  // Halves an edge on the boundary, or divides it where it meets a crease; a vertex near the crease is moved onto it.
  void divide(const MeshEdge& e) {
    const RefinementWay& way = way_around(hard_, middle_of(e));
    if (const auto crease = crease_on(e, way)) {
      if (divide_at(*crease, e, way)) return;
    }
    std::vector<Step> steps;
    const double lift = crease_at_[e.a] || crease_at_[e.b] || !is_balanced() ? 0 : 0.5 * (lift_of(e.a) + lift_of(e.b));
    for (const double height : {lift, 0.0}) {
      for (const double s : kSlides) {
        const Vec3 p = point(e.a) + s * (point(e.b) - point(e.a));
        const BoundaryPoint at = onto_boundary(field_, p, cone(e.a), kTolerance, height);
        steps.push_back(mesh_.splitting(e, finished_vertex(at, field_)));
      }
    }
    place(steps, std::nullopt, way);
  }

  bool divide_at(const CreasePoint& crease, const MeshEdge& e, const RefinementWay& way) {
    const BoundaryPoint& at = crease.at;
    const double share = (at.position - point(e.a)).dot(point(e.b) - point(e.a)) / (length(e) * length(e));
    if ((at.position - middle_of(e)).norm() > length(e)) {
      if (!way.descends) return false;
      const BoundaryPoint lower = towards(at, middle_of(e), length(e));
      return place({mesh_.splitting(e, finished_vertex(lower, field_))}, crease.crease, way);
    }
    if (share > kNearEnd && share < 1 - kNearEnd)
      return place({mesh_.splitting(e, finished_vertex(at, field_))}, crease.crease, way);
    const Index end = share <= kNearEnd ? e.a : e.b;
    return !held_[end] && !crease_at_[end] &&
           place({mesh_.moving(end, finished_vertex(at, field_))}, crease.crease, way);
  }

  // Takes the best of the steps by which no triangle turns over.
  bool place(std::vector<Step> steps, const std::optional<Crease>& crease, const RefinementWay& way) {
    Index placed = kNone;
    for (const double least : way.upright_splits) {
      std::vector<Step> upright;
      std::copy_if(steps.begin(), steps.end(), std::back_inserter(upright),
                   [&](const Step& step) { return stays_upright(step, least); });
      placed = take(upright, kWorstSkewness);
      if (placed != kNone) break;
    }
    if (placed != kNone) crease_at_[placed] = crease;
    return placed != kNone;
  }

  bool is_balanced() const { return goal_.placement == Placement::balanced; }
  double lift_of(Index v) const { return distance_by_slope(field_.sample(point(v), cone(v))); }
  Vec3 middle_of(const MeshEdge& e) const { return 0.5 * (point(e.a) + point(e.b)); }

  // Where the boundaries of two cones meet, near the middle of an edge that crosses there or runs along.
  std::optional<CreasePoint> crease_on(const MeshEdge& e, const RefinementWay& way) const {
    for (const Crease& crease : creases_between(e)) {
      if (const auto at = onto_crease(field_, crease, middle_of(e), limit_of(e))) return CreasePoint{crease, *at};
    }
    return way.into_gaps ? end_of_gap(e) : std::nullopt;
  }

  // Of an edge from wall to wall across a gap: the end of the gap.
  std::optional<CreasePoint> end_of_gap(const MeshEdge& e) const {
    const FieldSample a = field_.sample(point(e.a), cone(e.a)), b = field_.sample(point(e.b), cone(e.b));
    const auto notch = gaps_.notch_below(middle_of(e), a, b, kTolerance * limit_of(e));
    if (!notch) return std::nullopt;
    return CreasePoint{std::minmax(notch->walls.first_cone, notch->walls.second_cone), notch->end};
  }

  // The point on the way from p to a target, no farther than `most`.
  BoundaryPoint towards(const BoundaryPoint& target, const Vec3& p, double most) const {
    const Vec3 way = target.position - p;
    const Vec3 at = p + std::min(1.0, most / way.norm()) * way;
    return {at, field_.sample(at, target.sample.cone)};
  }

  std::vector<Crease> creases_between(const MeshEdge& e) const {
    const auto cones_at = [&](Index v) {
      if (crease_at_[v]) return std::vector<Index>{crease_at_[v]->first, crease_at_[v]->second};
      return std::vector<Index>{field_.sample(point(v), cone(v)).cone};
    };
    return vmesh::creases_between(field_, {point(e.a), cones_at(e.a)}, {point(e.b), cones_at(e.b)});
  }

  Index take(const std::vector<Step>& steps, double worst) {
    const Index placed = edit_.take_best(steps, worst);
    if (placed == kNone) return placed;
    held_.resize(mesh_.vertices().size(), 0);
    crease_at_.resize(mesh_.vertices().size());
    const auto& fan = mesh_.faces_around(placed);
    changed_.insert(changed_.end(), fan.begin(), fan.end());
    return placed;
  }

  double skewness(const PlacedFace& f) const { return equiangle_skewness(f.points[0], f.points[1], f.points[2]); }
  double worst_skewness(const Step& step) const {
    double worst = 0;
    for (const Triangle& f : step.faces) worst = std::max(worst, skewness(mesh_.placed(f, step)));
    return worst;
  }
  double worst_now(const Step& step) const {
    double worst = 0;
    for (const Index f : step.gone) worst = std::max(worst, skewness(mesh_.placed(f)));
    return worst;
  }

  void improve() {
    std::vector<Index> faces = changed_;
    for (int pass = 0; pass < kImprovements && !faces.empty(); ++pass) {
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
      due_.insert(due_.end(), faces.begin(), faces.end());
      changed_.clear();
      for (const Index f : faces) {
        for (const std::size_t k : {0, 1, 2}) {
          if (!mesh_.has_face(f)) continue;
          const Triangle& face = mesh_.faces()[f];
          flip({face[k], face[(k + 1) % 3]});
        }
      }
      std::vector<Index> vertices;
      for (const Index f : faces) {
        if (mesh_.has_face(f)) vertices.insert(vertices.end(), mesh_.faces()[f].begin(), mesh_.faces()[f].end());
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      for (const Index v : vertices) move(v);
      faces = changed_;
    }
    due_.insert(due_.end(), faces.begin(), faces.end());
    std::sort(due_.begin(), due_.end());
    due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
  }

  // Vertices that growth left beyond the limit, in valleys where the field has hardly a slope: one alone keeps all
  // faces around it from being proven, and what is added there crosses them.
  void bring_strays_back() {
    changed_.clear();
    for (Index v = 0; v < mesh_.vertices().size(); ++v) {
      if (!mesh_.has_vertex(v) || held_[v] || std::abs(lift_of(v)) <= limit_at(v)) continue;
      const BoundaryPoint target = onto_boundary(field_, point(v), cone(v), kTolerance, 0);
      if (!take_upright({mesh_.moving(v, finished_vertex(target, field_))}, v)) take_upright(merging(v), v);
    }
    improve();
  }

  // Where walls meet in creases. Again when faces are smaller: then more strips have good triangles.
  void go_down_into_gaps(const std::vector<Index>& faces) {
    if (!has_creases_) return;
    changed_.clear();
    const auto placed = plough(
        mesh_, edit_, field_, faces, [this](Index v) { return limit_at(v); }, held_);
    held_.resize(mesh_.vertices().size(), 0);
    crease_at_.resize(mesh_.vertices().size());
    for (const auto& [v, crease] : placed) {
      crease_at_[v] = crease;
      const auto& fan = mesh_.faces_around(v);
      changed_.insert(changed_.end(), fan.begin(), fan.end());
    }
    improve();
  }

  // All ways to merge a vertex with one beside it, which stays where it is.
  std::vector<Step> merging(Index v) const {
    std::vector<Step> steps;
    for (const Index f : mesh_.faces_around(v)) {
      const Index w = FinishedMesh::turned_to(v, mesh_.faces()[f])[1];
      if (mesh_.may_collapse({v, w})) steps.push_back(mesh_.collapsing(v, w, mesh_.vertex(w)));
    }
    return steps;
  }

  bool take_upright(std::vector<Step> steps, Index v) {
    std::erase_if(steps, [&, least = way_around(hard_, point(v)).upright](const Step& step) {
      return !stays_upright(step, least);
    });
    return take(steps, kWorstSkewness) != kNone;
  }

  void flip(const MeshEdge& e) {
    if (!mesh_.is_inner(e) || !mesh_.may_flip(e)) return;
    const Step step = mesh_.flipping(e);
    const auto [c, d] = mesh_.opposite(e);
    const double now = worst_now(step), then = worst_skewness(step), off_now = off_at(e), off_then = off_at({c, d});
    const bool is_nearer = off_now > kWorthAProof && off_then < 0.7 * off_now && then < kWorstSkewness;
    const bool is_better = then < now - kLeastGain && off_then < std::max(off_now, 0.7 * kWorthAProof);
    const bool is_regular = then < kRound && off_then < kWorthAProof * 0.9 && irregularity_after(e, c, d) < 0;
    if ((is_nearer || is_better || is_regular) && stays_upright(step, way_around(hard_, point(e.a)).upright))
      take({step}, kWorstSkewness);
  }

  // How the squares of the differences from six edges at a vertex change by a flip.
  int irregularity_after(const MeshEdge& e, Index c, Index d) const {
    const auto change = [&](Index v, int by) {
      const int difference = static_cast<int>(mesh_.faces_around(v).size()) - 6;
      return (difference + by) * (difference + by) - difference * difference;
    };
    return change(e.a, -1) + change(e.b, -1) + change(c, 1) + change(d, 1);
  }

  double energy(const Step& step) const {
    double sum = 0;
    for (const Triangle& f : step.faces) {
      const PlacedFace face = mesh_.placed(f, step);
      sum += squared_inverse_mean_ratio(face.points[0], face.points[1], face.points[2]);
    }
    return sum;
  }

  bool stays_upright(const Step& step, double least) const {
    return std::all_of(step.faces.begin(), step.faces.end(), [&](const Triangle& f) {
      const PlacedFace face = mesh_.placed(f, step);
      const Vec3 normal = (face.points[1] - face.points[0]).cross(face.points[2] - face.points[0]);
      const Vec3 center = (face.points[0] + face.points[1] + face.points[2]) / 3;
      const Vec3 gradient =
          rough_sample(center, step.vertex == kNone ? cone(f[0]) : step.target.binding.segment).gradient;
      return normal.dot(gradient) > least * normal.norm() * gradient.norm();
    });
  }

  // To where its triangles have the best shape, as high as balances them.
  void move(Index v) {
    if (!mesh_.has_vertex(v) || held_[v]) return;
    double area = 0, sum = 0;
    const double height = lift_of(v);
    PlanarEnergy shape;
    const Vec3 normal = mesh_.vertex_normal(v), u = normal.unitOrthogonal(), w = normal.cross(u);
    for (const Index f : mesh_.faces_around(v)) {
      const Triangle face = FinishedMesh::turned_to(v, mesh_.faces()[f]);
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
    const double off_now = off_around(v), upright = way_around(hard_, point(v)).upright;
    const Vec3 way = best_way(shape, u, w, kLongestMove * mesh_.mean_edge(v));
    for (const double share : {1.0, 0.5, 0.0}) {
      const Vec3 p = point(v) + share * way;
      const auto on_crease = crease_at_[v] ? onto_crease(field_, *crease_at_[v], p, limit_at(v)) : std::nullopt;
      if (crease_at_[v] && !on_crease) continue;
      const BoundaryPoint target =
          on_crease ? towards(*on_crease, p, mesh_.mean_edge(v)) : onto_boundary(field_, p, cone(v), kTolerance, lift);
      const bool is_lower = on_crease && height > most && distance_by_slope(target.sample) < 0.9 * height;
      const Step step = mesh_.moving(v, finished_vertex(target, field_));
      const double worst = std::max(worst_now(step), kRound);
      const bool is_rounder = energy(step) < (1 - rounder) * shape.value;
      const bool is_lifted = !crease_at_[v] && std::abs(lift - height) > worth_a_lift * most;
      if (!(is_rounder || is_lifted || is_lower) || worst_skewness(step) > worst || !stays_upright(step, upright))
        continue;
      if (off_around(v, target.position) > std::max(kWorthAProof * 0.9, off_now)) continue;
      if (take({step}, worst) != kNone) break;
    }
  }

  // Whether a vertex or one beside it is on a crease.
  bool is_at_crease(Index v) const {
    const auto& fan = mesh_.faces_around(v);
    return has_creases_ && std::any_of(fan.begin(), fan.end(), [&](Index f) {
             const Triangle& face = mesh_.faces()[f];
             return std::any_of(face.begin(), face.end(), [&](Index w) { return crease_at_[w].has_value(); });
           });
  }

  // One Newton step, no longer than `longest`.
  static Vec3 best_way(const PlanarEnergy& shape, const Vec3& u, const Vec3& w, double longest) {
    if (!std::isfinite(shape.value)) return Vec3::Zero();
    const Eigen::Vector2d step = -shape.hessian.inverse() * shape.gradient;
    const double length = step.norm();
    if (!std::isfinite(length)) return Vec3::Zero();
    return std::min(1.0, longest / length) * (step.x() * u + step.y() * w);
  }

  double off_around(Index v) const { return off_around(v, point(v)); }
  double off_around(Index v, const Vec3& p) const {
    double worst = 0;
    for (const Index f : mesh_.faces_around(v)) {
      Vec3 center = p / 3;
      for (const Index w : mesh_.faces()[f]) {
        if (w == v) continue;
        center += point(w) / 3;
        worst = std::max(worst, off_at(0.5 * (p + point(w)), cone(w)));
      }
      worst = std::max(worst, off_at(center, cone(v)));
    }
    return worst / limit_at(v);
  }

  void prove() {
    unproven_ = proof_.unproven(
        mesh_, due_, [this](Index v) { return limit_at(v); }, [this](Index f) { return is_far(f); });
    due_.clear();
    std::erase_if(unproven_, [this](Index f) { return is_at_opening(f); });
  }

  std::vector<Index> finish(const std::vector<Index>& unproven) {
    std::vector<Index> number(mesh_.faces().size());
    Index next = 0;
    for (Index f = 0; f < number.size(); ++f) number[f] = mesh_.has_face(f) ? next++ : kNone;
    std::vector<Index> left;
    for (const Index f : unproven) left.push_back(number[f]);
    put_back(std::move(mesh_), surface_);
    return left;
  }

  FinishedSurface& surface_;
  const VesselField& field_;
  const bool has_creases_ = field_.relations().blend() == 0;
  const RefinementGoal& goal_;
  const std::vector<HardPlace>& hard_;
  const Progress& progress_;
  RefinedProof proof_;
  Gaps gaps_;
  FinishedMesh mesh_;
  GuardedEdit<FinishedVertex> edit_;
  std::vector<char> held_;                        // by vertex
  std::vector<std::optional<Crease>> crease_at_;  // of every vertex on one
  std::vector<Index> changed_;                    // faces, by the steps of this pass
  std::vector<Index> due_;                        // faces that are new or have moved
  std::vector<Index> unproven_;
};

}  // namespace

std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                          const std::vector<HardPlace>& hard, const Progress& progress) {
  return Refinement(surface, field, goal, hard, progress).run();
}

}  // namespace vmesh
