#include "surface/proof/notches.h"

#include <algorithm>
#include <map>
#include <optional>

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/edit/guarded_edit.h"
#include "vmesh/mesh/triangle_quality.h"
#include "vmesh/surface/soundness.h"

#include "surface/check/error_limit.h"
#include "surface/check/surface_proof.h"
#include "surface/proof/gap.h"

namespace vmesh {
namespace {

// Height of a vertex above the gap's end, in limits: leaves room for the surface between vertices. 0.1 to 0.5 work as
// well; idle 0.17 to 0.35.
constexpr double kFilled = 0.25;
// Cosine between the wall normals at an edge's ends above which it lies along a single wall; idle 0.35 to 0.7.
constexpr double kFacing = 0.5;
// Difference between an edge midpoint's distances from the two walls up to which it is in the gap; idle 0.17 to 0.35.
constexpr double kInGap = 0.25;
// In limits: an edge higher than that above the gap's end is not at a notch; idle 7 to 14.
constexpr double kFarthest = 10;
constexpr double kBadForNow = 0.995;                       // skewness that flips may mend; idle 0.7 to 1.4
constexpr double kSlides[] = {0, 0.15, -0.15, 0.3, -0.3};  // of the edge, along the notch
// Rounds in a row without fewer unproven faces; the trees below need one at most; idle 1 to 3.
constexpr int kRounds = 2;

// Strategies, each starting from the original surface, until everything is proven. The first is enough on vessel_portal
// and tree119 at 10 % and 5 % and on tree1560 at 10 %; the second is needed for one of 45 notches of tree1560 at 5 %,
// the third for daughters that part at 20 degrees.
struct Way {
  std::vector<double> filled;  // heights above the end of a gap to try, in limits
  double least_move;           // of a vertex into the notch, in limits
};
const Way kWays[] = {{{kFilled}, 0.25}, {{kFilled, 2 * kFilled, 3 * kFilled}, 0.1}, {{0.4}, 0.1}};

// Closes the notches of a surface with one strategy.
class Closing {
 public:
  Closing(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit, const Way& way)
      : surface_(surface), field_(field), gaps_(field), limit_(limit), way_(way) {}

  // Works at the unproven faces. Returns whether anything was done.
  bool improve(const std::vector<Index>& unproven) {
    mesh_ = finished_mesh(surface_);
    held_.assign(mesh_.vertices().size(), 0);
    for (const Index v : surface_.held) held_[v] = 1;
    edit_.emplace(mesh_);
    const std::vector<MeshEdge> edges = edges_of(unproven);
    bool any = close_all(edges, kWorstSkewness);
    if (!any) {
      any = close_all(edges, kBadForNow);
      edit_->mend(kWorstSkewness);
    }
    if (!any) {
      for (const MeshEdge& e : edges) any = halve(e) || any;
    }
    edit_.reset();
    renumber(put_back(std::move(mesh_), surface_));
    return any;
  }

  // Notches with adjacent vertices are merged.
  std::vector<ClosedNotch> closed() const {
    std::vector<ClosedNotch> notches;
    DisjointSets joined(surface_.mesh.vertices.size());
    for (const Triangle& f : surface_.mesh.faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (across_.contains(f[k]) && across_.contains(f[(k + 1) % 3])) joined.join(f[k], f[(k + 1) % 3]);
      }
    }
    std::map<Index, std::size_t> number;
    for (const auto& [v, across] : across_) {
      const auto [it, is_new] = number.emplace(joined.find(v), notches.size());
      if (is_new) notches.emplace_back();
      ClosedNotch& notch = notches[it->second];
      ++notch.vertices;
      const double depth = depth_at(v, across);
      if (depth <= notch.depth && !is_new) continue;
      notch.depth = depth;
      notch.position = surface_.mesh.vertices[v];
    }
    deepest_first(notches);
    return notches;
  }

 private:
  using Step = FinishedMesh::Step;

  const Vec3& point(Index v) const { return mesh_.position(v); }
  Vec3 middle_of(const MeshEdge& e) const { return 0.5 * (point(e.a) + point(e.b)); }
  double length(const MeshEdge& e) const { return (point(e.a) - point(e.b)).norm(); }
  double limit_at(const MeshEdge& e) const {
    return limit_.at(std::min(mesh_.vertex(e.a).radius, mesh_.vertex(e.b).radius));
  }

  // Longest first.
  std::vector<MeshEdge> edges_of(const std::vector<Index>& faces) const {
    std::vector<MeshEdge> edges;
    for (const Index f : faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = mesh_.faces()[f][k], b = mesh_.faces()[f][(k + 1) % 3];
        if (held_[a] || held_[b]) continue;
        edges.push_back({std::min(a, b), std::max(a, b)});
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::stable_sort(edges.begin(), edges.end(),
                     [&](const MeshEdge& e, const MeshEdge& f) { return length(e) > length(f); });
    return edges;
  }

  bool close_all(const std::vector<MeshEdge>& edges, double worst) {
    bool any = false;
    for (const MeshEdge& e : edges) any = (mesh_.is_inner(e) && close(e, worst)) || any;
    return any;
  }

  // An edge from wall to wall across a gap.
  struct Crossing {
    MeshEdge edge;
    Vec3 across, up;
    double limit;
    Index hint;
  };

  std::optional<Crossing> crossing_at(const MeshEdge& e) const {
    const FieldSample a = field_.sample(point(e.a), mesh_.vertex(e.a).binding.segment),
                      b = field_.sample(point(e.b), mesh_.vertex(e.b).binding.segment);
    if (a.gradient.dot(b.gradient) > kFacing) return std::nullopt;
    const Crossing crossing{e, a.gradient - b.gradient, (a.gradient + b.gradient).normalized(), limit_at(e), a.cone};
    const Walls walls = gaps_.walls_at(middle_of(e), crossing.across, a.cone);
    if (std::min(walls.first, walls.second) < kInGap * std::max(walls.first, walls.second)) return std::nullopt;
    if (!is_above(middle_of(e), end_from(middle_of(e), crossing, kFilled), crossing)) return std::nullopt;
    return crossing;
  }

  std::optional<BoundaryPoint> end_from(const Vec3& p, const Crossing& crossing, double filled) const {
    return gaps_.end_from(p, crossing.across, crossing.hint, filled * crossing.limit, 0.1 * filled * crossing.limit);
  }

  // Whether the gap's end is too far below p.
  bool is_above(const Vec3& p, const std::optional<BoundaryPoint>& end, const Crossing& crossing) const {
    return end && (p - end->position).dot(crossing.up) >= kFilled * crossing.limit &&
           (p - end->position).norm() < kFarthest * crossing.limit;
  }

  bool close(const MeshEdge& e, double worst) {
    const std::optional<Crossing> crossing = crossing_at(e);
    if (!crossing) return false;
    if (lies_low(*crossing) && edit_->take_best({mesh_.flipping(e)}, worst) != kNone) return true;
    std::vector<Step> steps = splits(*crossing);
    for (const Index v : {e.a, e.b}) {
      const auto end = end_from(point(v), *crossing, kFilled);
      if (!end) continue;
      const double way = (end->position - point(v)).norm();
      if (way > way_.least_move * crossing->limit && way < crossing->limit)
        steps.push_back(mesh_.moving(v, finished_vertex(*end, field_)));
    }
    if (mesh_.may_collapse(e))
      steps.push_back(mesh_.collapsing(e.a, e.b, finished_vertex(*end_from(middle_of(e), *crossing, kFilled), field_)));
    const Index placed = edit_->take_best(steps, worst);
    if (placed != kNone) across_[placed] = crossing->across;
    return placed != kNone;
  }

  // Whether the other diagonal of the edge's faces is at the end of the gap already.
  bool lies_low(const Crossing& crossing) const {
    if (!mesh_.may_flip(crossing.edge)) return false;
    const auto [c, d] = mesh_.opposite(crossing.edge);
    const auto end = end_from(middle_of({c, d}), crossing, kFilled);
    return end && !is_above(middle_of({c, d}), end, crossing);
  }

  std::vector<Step> splits(const Crossing& crossing) const {
    std::vector<Step> steps;
    const Vec3 along = crossing.across.cross(crossing.up).normalized();
    for (const double slide : kSlides) {
      const Vec3 p = middle_of(crossing.edge) + slide * length(crossing.edge) * along;
      for (const double filled : way_.filled) {
        const auto end = end_from(p, crossing, filled);
        if (is_above(p, end, crossing)) steps.push_back(mesh_.splitting(crossing.edge, finished_vertex(*end, field_)));
      }
    }
    return steps;
  }

  // Splits an edge along a wall if it is longer than the limit.
  bool halve(const MeshEdge& e) {
    if (!mesh_.is_inner(e) || length(e) < limit_at(e)) return false;
    std::vector<Step> steps;
    for (const double slide : kSlides) {
      const Vec3 p = middle_of(e) + slide * (point(e.b) - point(e.a));
      const BoundaryPoint at = project_to_boundary(field_, p, mesh_.vertex(e.a).binding.segment);
      steps.push_back(mesh_.splitting(e, finished_vertex(at, field_)));
    }
    return edit_->take_best(steps, kWorstSkewness) != kNone;
  }

  void renumber(const std::vector<Index>& number) {
    std::map<Index, Vec3> across;
    for (const auto& [v, direction] : across_) {
      if (number[v] != kNone) across.emplace(number[v], direction);
    }
    across_ = std::move(across);
  }

  double depth_at(Index v, const Vec3& across) const {
    const Vec3& p = surface_.mesh.vertices[v];
    const double tolerance = 0.01 * limit_.at(surface_.radius[v]);
    const auto end = gaps_.end_from(p, across, surface_.binding[v].segment, 0, tolerance);
    return end ? (end->position - p).norm() : 0;
  }

  FinishedSurface& surface_;
  const VesselField& field_;
  Gaps gaps_;
  const ErrorLimit& limit_;
  const Way& way_;
  FinishedMesh mesh_;  // while improve() works on it
  std::optional<GuardedEdit<FinishedVertex>> edit_;
  std::vector<char> held_;        // by vertex that it had
  std::map<Index, Vec3> across_;  // vertices at the ends of gaps, with the direction across
};

std::size_t count_bad(const TriMesh& mesh) {
  const std::vector<double> skewness = equiangle_skewness(mesh);
  return static_cast<std::size_t>(
      std::count_if(skewness.begin(), skewness.end(), [](double s) { return s > kWorstSkewness; }));
}

}  // namespace

void deepest_first(std::vector<ClosedNotch>& notches) {
  std::stable_sort(notches.begin(), notches.end(),
                   [](const ClosedNotch& a, const ClosedNotch& b) { return a.depth > b.depth; });
}

ErrorSummary close_notches(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit) {
  SurfaceProof proof(field, limit);
  const auto find_unproven = [&](const FinishedSurface& s) { return proof.unproven(s.mesh, s.binding); };
  const FinishedSurface first = surface;
  const std::vector<Index> at_first = find_unproven(first);
  const std::size_t bad_at_first = count_bad(first.mesh);
  std::vector<Index> fewest = at_first;
  std::vector<ClosedNotch> notches;
  for (const Way& way : kWays) {
    FinishedSurface changed = first;
    Closing closing(changed, field, limit, way);
    std::vector<Index> unproven = at_first;
    std::size_t least = unproven.size();
    for (int round = 0, best = 0; !fewest.empty() && round < best + kRounds && closing.improve(unproven); ++round) {
      unproven = find_unproven(changed);
      if (unproven.size() < least) best = round + 1;
      least = std::min(least, unproven.size());
      if (unproven.size() >= fewest.size() || count_bad(changed.mesh) > bad_at_first) continue;
      fewest = unproven;
      surface = changed;
      notches = closing.closed();
    }
    if (closing.closed().empty()) break;
  }
  return {fewest.size(), places_of(surface.mesh, fewest), std::move(notches)};
}

}  // namespace vmesh
