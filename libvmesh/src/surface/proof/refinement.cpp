#include "surface/proof/refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <tbb/parallel_for.h>

#include "vmesh/surface/soundness.h"

#include "surface/proof/by_slope.h"
#include "surface/proof/crease.h"
#include "surface/proof/furrows.h"
#include "surface/proof/gap.h"
#include "surface/proof/refined_proof.h"
#include "surface/proof/refined_surface.h"

namespace vmesh {
namespace {

constexpr int kMostSplitRounds = 12;  // each halves edges
constexpr double kNearEnd = 0.2;  // share of an edge from its end within which its end is moved onto a crease instead
constexpr double kSlides[] = {0.5, 0.4, 0.6};  // where edges are divided

class Refinement {
 public:
  Refinement(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal, const Progress& progress)
      : finished_(surface),
        field_(field),
        goal_(goal),
        way_(refinement_way(goal.way)),
        progress_(progress),
        proof_(field, goal.bends_at_once),
        gaps_(field),
        surface_(surface, field, goal) {
    for (Index f = 0; f < surface_.mesh.faces().size(); ++f) due_.push_back(f);
  }

  std::vector<Index> run() {
    bring_strays_back();
    go_down_into_gaps(due_);
    for (int round = 0; round < kMostSplitRounds && split_where_far(); ++round) surface_.improve(due_);
    prove();
    const double at_first = unproven_area();
    double least = at_first;
    std::vector<Index> best = unproven_;
    std::optional<FinishedMesh::Transaction> since_best;
    since_best.emplace(surface_.mesh);
    for (int round = 0, last = 0; !unproven_.empty() && round < last + goal_.patience; ++round) {
      report_progress(progress_, "refine", 1 - least / at_first);
      go_down_into_gaps(unproven_);
      if (!split_unproven()) break;
      surface_.improve(due_);
      prove();
      if (unproven_area() >= least) continue;
      least = unproven_area();
      best = unproven_;
      last = round + 1;
      since_best->keep();
      since_best.emplace(surface_.mesh);
    }
    since_best.reset();
    return finish(best);
  }

 private:
  using Step = RefinedSurface::Step;

  double off_at_center(const Triangle& f) const {
    const Vec3 center = (surface_.point(f[0]) + surface_.point(f[1]) + surface_.point(f[2])) / 3;
    return surface_.off_at(center, surface_.cone(f[0])) / surface_.limit_of(f);
  }

  double unproven_area() const {
    double area = 0;
    for (const Index f : unproven_) area += surface_.mesh.area_normal(f).norm() / 2;
    return area;
  }

  bool may_split(const MeshEdge& e) const {
    if (!surface_.mesh.is_inner(e) || (surface_.held[e.a] && surface_.held[e.b])) return false;
    const double radius = std::min(surface_.mesh.vertex(e.a).radius, surface_.mesh.vertex(e.b).radius);
    return surface_.length(e) > way_.shortest * std::sqrt(surface_.limit_of(e) * radius);
  }

  bool is_at_opening(Index f) const {
    const auto& [a, b, c] = surface_.mesh.faces()[f];
    return surface_.held[a] || surface_.held[b] || surface_.held[c];
  }

  // What is worst among the edges of a face, or its longest edge if its middle is worst.
  struct Candidate {
    double off = 0;
    MeshEdge edge;
  };
  Candidate worst_of(Index f) const {
    const Triangle& face = surface_.mesh.faces()[f];
    Candidate worst;
    MeshEdge longest = {face[0], face[1]};
    for (const MeshEdge& e : surface_.edges_of(face)) {
      if (surface_.length(e) > surface_.length(longest)) longest = e;
      const double off = surface_.off_at(e);
      if (off > worst.off) worst = {off, e};
    }
    const double center = off_at_center(face);
    if (center > worst.off) worst = {center, longest};
    return worst;
  }

  // Whether a face is known to be beyond the limit: the boundary is nowhere nearer than the distance tells.
  bool is_far(Index f) const {
    const Triangle& face = surface_.mesh.faces()[f];
    const auto [a, b, c] = surface_.mesh.corners(f);
    const std::array<Vec3, 4> middles = {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3};
    return std::any_of(middles.begin(), middles.end(), [&](const Vec3& p) {
      return std::abs(surface_.rough_sample(p, surface_.cone(face[0])).distance) > surface_.limit_of(face);
    });
  }

  bool split_where_far() {
    std::vector<Candidate> candidates(due_.size());
    tbb::parallel_for(std::size_t{0}, due_.size(), [&](std::size_t i) {
      if (surface_.mesh.has_face(due_[i]) && !is_at_opening(due_[i])) candidates[i] = worst_of(due_[i]);
    });
    due_.clear();
    std::erase_if(candidates, [](const Candidate& c) { return c.off <= kWorthAProof; });
    return split(std::move(candidates));
  }

  bool split_unproven() {
    std::vector<Candidate> candidates;
    for (const Index f : unproven_) {
      if (!surface_.mesh.has_face(f)) continue;
      Candidate c = worst_of(f);
      // Nothing is far; long edges make proofs hard.
      if (c.off <= kWorthAProof) {
        for (const MeshEdge& e : surface_.edges_of(surface_.mesh.faces()[f])) {
          if (surface_.length(e) > surface_.length(c.edge)) c.edge = e;
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
    surface_.changed.clear();
    for (const Candidate& c : candidates) {
      if (surface_.mesh.vertices().size() >= goal_.most_vertices) break;
      if (!may_split(c.edge)) continue;
      divide(c.edge);
    }
    return !surface_.changed.empty();
  }

  struct CreasePoint {
    Crease crease;
    BoundaryPoint at;
  };

  // Halves an edge on the boundary, or divides it where it meets a crease; a vertex near the crease is moved onto it.
  void divide(const MeshEdge& e) {
    if (const auto crease = crease_on(e)) {
      if (divide_at(*crease, e)) return;
    }
    if (way_.at_kinks && divide_at_kink(e)) return;
    std::vector<Step> steps;
    const double lift = surface_.crease_at[e.a] || surface_.crease_at[e.b] || !surface_.is_balanced()
                            ? 0
                            : 0.5 * (surface_.lift_of(e.a) + surface_.lift_of(e.b));
    for (const double height : {lift, 0.0}) {
      for (const double s : kSlides) {
        const Vec3 p = surface_.point(e.a) + s * (surface_.point(e.b) - surface_.point(e.a));
        const BoundaryPoint at = onto_boundary(field_, p, surface_.cone(e.a), kRefinedTolerance, height);
        steps.push_back(surface_.mesh.splitting(e, finished_vertex(at, field_)));
      }
    }
    place(steps, std::nullopt);
  }

  bool divide_at(const CreasePoint& crease, const MeshEdge& e) {
    const BoundaryPoint& at = crease.at;
    const double share = share_along(e, at.position);
    if ((at.position - surface_.middle_of(e)).norm() > surface_.length(e)) {
      if (!way_.descends) return false;
      const BoundaryPoint lower = surface_.towards(at, surface_.middle_of(e), surface_.length(e));
      return place({surface_.mesh.splitting(e, finished_vertex(lower, field_))}, crease.crease);
    }
    if (share > kNearEnd && share < 1 - kNearEnd)
      return place({surface_.mesh.splitting(e, finished_vertex(at, field_))}, crease.crease);
    const Index end = share <= kNearEnd ? e.a : e.b;
    return !surface_.held[end] && !surface_.crease_at[end] &&
           place({surface_.mesh.moving(end, finished_vertex(at, field_))}, crease.crease);
  }

  // Where the boundary bends sharply, a vertex is put there and stays.
  bool divide_at_kink(const MeshEdge& e) {
    const auto end_at = [&](Index v) {
      return BoundaryPoint{surface_.point(v), field_.sample(surface_.point(v), surface_.cone(v))};
    };
    const auto kink = onto_kink(field_, end_at(e.a), end_at(e.b), surface_.limit_of(e));
    if (!kink) return false;
    const FinishedVertex vertex = finished_vertex(*kink, field_);
    const double share = share_along(e, kink->position);
    if (share > kNearEnd && share < 1 - kNearEnd) return stays(place({surface_.mesh.splitting(e, vertex)}));
    const Index end = share <= kNearEnd ? e.a : e.b;
    return !surface_.held[end] && !surface_.at_kink[end] && stays(place({surface_.mesh.moving(end, vertex)}));
  }

  bool stays(Index placed) {
    if (placed != kNone) surface_.at_kink[placed] = 1;
    return placed != kNone;
  }

  double share_along(const MeshEdge& e, const Vec3& p) const {
    const Vec3 &a = surface_.point(e.a), &b = surface_.point(e.b);
    return (p - a).dot(b - a) / (b - a).squaredNorm();
  }

  bool place(std::vector<Step> steps, const std::optional<Crease>& crease) {
    const Index placed = place(std::move(steps));
    if (placed != kNone) surface_.crease_at[placed] = crease;
    return placed != kNone;
  }

  // Takes the best of the steps by which no triangle turns over.
  Index place(std::vector<Step> steps) {
    Index placed = kNone;
    for (const double least : way_.upright_splits) {
      std::vector<Step> upright;
      std::copy_if(steps.begin(), steps.end(), std::back_inserter(upright),
                   [&](const Step& step) { return surface_.stays_upright(step, least); });
      placed = surface_.take(upright, kWorstSkewness);
      if (placed != kNone) break;
    }
    return placed;
  }

  // Where the boundaries of two cones meet, near the middle of an edge that crosses there or runs along.
  std::optional<CreasePoint> crease_on(const MeshEdge& e) const {
    for (const Crease& crease : creases_between(e)) {
      if (const auto at = onto_crease(field_, crease, surface_.middle_of(e), surface_.limit_of(e)))
        return CreasePoint{crease, *at};
    }
    return way_.into_gaps ? end_of_gap(e) : std::nullopt;
  }

  // Of an edge from wall to wall across a gap: the end of the gap.
  std::optional<CreasePoint> end_of_gap(const MeshEdge& e) const {
    const FieldSample a = field_.sample(surface_.point(e.a), surface_.cone(e.a)),
                      b = field_.sample(surface_.point(e.b), surface_.cone(e.b));
    const auto notch = gaps_.notch_below(surface_.middle_of(e), a, b, kRefinedTolerance * surface_.limit_of(e));
    if (!notch) return std::nullopt;
    return CreasePoint{std::minmax(notch->walls.first_cone, notch->walls.second_cone), notch->end};
  }

  std::vector<Crease> creases_between(const MeshEdge& e) const {
    const auto cones_at = [&](Index v) {
      if (surface_.crease_at[v]) return std::vector<Index>{surface_.crease_at[v]->first, surface_.crease_at[v]->second};
      return std::vector<Index>{field_.sample(surface_.point(v), surface_.cone(v)).cone};
    };
    return vmesh::creases_between(field_, {surface_.point(e.a), cones_at(e.a)}, {surface_.point(e.b), cones_at(e.b)});
  }

  // Vertices that growth left beyond the limit, in valleys where the field has hardly a slope: one alone keeps all
  // faces around it from being proven, and what is added there crosses them.
  void bring_strays_back() {
    surface_.changed.clear();
    for (Index v = 0; v < surface_.mesh.vertices().size(); ++v) {
      if (!surface_.mesh.has_vertex(v) || surface_.held[v] || std::abs(surface_.lift_of(v)) <= surface_.limit_at(v))
        continue;
      const BoundaryPoint target = onto_boundary(field_, surface_.point(v), surface_.cone(v), kRefinedTolerance, 0);
      if (!take_upright({surface_.mesh.moving(v, finished_vertex(target, field_))}))
        take_upright(merges(surface_.mesh, v));
    }
    surface_.improve(due_);
  }

  // Where walls meet in creases. Again when faces are smaller: then more strips have good triangles.
  void go_down_into_gaps(const std::vector<Index>& faces) {
    if (!surface_.has_creases) return;
    surface_.changed.clear();
    const auto placed = plough(
        surface_.mesh, surface_.edit, field_, faces, [this](Index v) { return surface_.limit_at(v); }, surface_.held);
    for (const auto& [v, crease] : placed) {
      surface_.note_faces_around(v);
      surface_.crease_at[v] = crease;
    }
    surface_.improve(due_);
  }

  bool take_upright(std::vector<Step> steps) {
    std::erase_if(steps, [&](const Step& step) { return !surface_.stays_upright(step, way_.upright); });
    return surface_.take(steps, kWorstSkewness) != kNone;
  }

  void prove() {
    unproven_ = proof_.unproven(
        surface_.mesh, due_, [this](Index v) { return surface_.limit_at(v); }, [this](Index f) { return is_far(f); });
    due_.clear();
    std::erase_if(unproven_, [this](Index f) { return is_at_opening(f); });
  }

  std::vector<Index> finish(const std::vector<Index>& unproven) {
    std::vector<Index> number(surface_.mesh.faces().size());
    Index next = 0;
    for (Index f = 0; f < number.size(); ++f) number[f] = surface_.mesh.has_face(f) ? next++ : kNone;
    std::vector<Index> left;
    for (const Index f : unproven) left.push_back(number[f]);
    put_back(std::move(surface_.mesh), finished_);
    return left;
  }

  FinishedSurface& finished_;
  const VesselField& field_;
  const RefinementGoal& goal_;
  const RefinementWay& way_;
  const Progress& progress_;
  RefinedProof proof_;
  Gaps gaps_;
  RefinedSurface surface_;
  std::vector<Index> due_;  // faces that are new or have moved
  std::vector<Index> unproven_;
};

}  // namespace

std::vector<Index> refine(FinishedSurface& surface, const VesselField& field, const RefinementGoal& goal,
                          const Progress& progress) {
  return Refinement(surface, field, goal, progress).run();
}

}  // namespace vmesh
