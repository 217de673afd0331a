#include "surface/proof/coarsening.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include <CGAL/boost/graph/Euler_operations.h>
#include <tbb/parallel_for.h>

#include "surface/proof/kept_proof.h"
#include "surface/remesh/least_skewness.h"

namespace vmesh {
namespace {

// None of these is in the surveys yet (libvmesh/README.md, Constants).
constexpr double kMostDeviation = 0.5;    // radii, whatever the limit: the axis stays inside
constexpr double kShareForSamples = 0.9;  // of the limit: beyond, proofs fail too often to be worth trying
constexpr double kWorstShape = 0.75;      // skewness of a face in its metric, unless one that it replaces was worse
constexpr double kOutdated = 1.05;        // a step whose cost has grown by so much waits for its turn
constexpr int kHeights = 40;              // of a new vertex, that are tried: within a twentieth of the best
constexpr double kBetter = 0.95;          // deviation after a step that leaves no vertex out against that before
constexpr double kMoves[] = {0, 0.5};     // of a vertex on its way to the middle of its neighbours
constexpr int kRounds = 5;
constexpr double kFewSteps = 0.02;   // of the vertices: not worth another round
constexpr double kTolerance = 1e-3;  // radii, of projections
constexpr int kPollInterval = 64;    // steps looked at, a millisecond each at most

struct Step : Replacement {
  double cost = 0;  // largest deviation, in limits
};

class Coarsener {
 public:
  Coarsener(BoundSurface& surface, const ErrorLimit& limit,
            const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress)
      : surface_(surface),
        mesh_(surface.mesh),
        state_(surface),
        field_(surface.field),
        proof_(state_, limit),
        limit_(limit),
        longest_(longest),
        progress_(progress) {
    for (const Vertex v : mesh_.vertices()) elongation_.push_back(longest_({surface_.cone[v], surface_.t[v]}));
    changed_.assign(mesh_.num_vertices(), 1);
  }

  void run() {
    const double enough = kFewSteps * static_cast<double>(mesh_.number_of_vertices());
    for (int round = 0; round < kRounds; ++round) {
      done_ = static_cast<double>(round) / kRounds;
      if (static_cast<double>(collapse_all()) < enough) break;
      relax();
    }
  }

 private:
  void poll() {
    if (++polls_ % kPollInterval == 0) report_progress(progress_, "coarsen", done_);
  }

  // One pass over all edges. Returns how many were collapsed.
  std::size_t collapse_all() {
    std::vector<Edge> edges;
    for (const Edge e : mesh_.edges()) {
      if (is_near_change(mesh_.vertex(e, 0)) || is_near_change(mesh_.vertex(e, 1))) edges.push_back(e);
    }
    changed_.assign(changed_.size(), 0);
    std::vector<double> cost(edges.size());
    tbb::parallel_for(std::size_t{0}, edges.size(), [&](std::size_t i) {
      const std::optional<Step> step = collapse_of(edges[i]);
      cost[i] = step ? step->cost : std::numeric_limits<double>::infinity();
    });
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (std::isfinite(cost[i])) queue.emplace(cost[i], edges[i].idx());
    }
    std::size_t count = 0;
    while (!queue.empty()) {
      poll();
      const auto [expected, index] = queue.top();
      queue.pop();
      const Edge e(index);
      if (mesh_.is_removed(e)) continue;
      const std::optional<Step> step = collapse_of(e);
      if (!step) continue;
      if (step->cost > kOutdated * expected) {
        queue.emplace(step->cost, index);
        continue;
      }
      if (!surface_.may_collapse(mesh_.vertex(e, 0), mesh_.vertex(e, 1), step->target.position)) continue;
      const std::optional<KeptProof::Outlook> outlook = proof_.after(*step);
      if (!outlook) continue;
      const Vertex v = collapse(e, *step, *outlook);
      ++count;
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
        for (const Edge changed : {mesh_.edge(h), mesh_.edge(mesh_.prev(h))}) {
          if (const std::optional<Step> next = collapse_of(changed)) queue.emplace(next->cost, changed.idx());
        }
      }
    }
    return count;
  }

  // Takes steps that leave fewer deviations and as many vertices, so that more can go.
  void relax() {
    for (const Edge e : mesh_.edges()) {
      poll();
      const std::optional<Step> step = flip_of(e);
      if (!step || !surface_.may_flip(mesh_.halfedge(e))) continue;
      const std::optional<KeptProof::Outlook> outlook = proof_.after(*step);
      if (!outlook) continue;
      CGAL::Euler::flip_edge(mesh_.halfedge(e), mesh_);
      surface_.touch_faces(step->at);
      note(*step, *outlook, step->at);
    }
    for (const Vertex v : mesh_.vertices()) {
      poll();
      const std::optional<Step> step = move_of(v);
      if (!step || !surface_.may_place(v, step->target.position)) continue;
      const std::optional<KeptProof::Outlook> outlook = proof_.after(*step);
      if (!outlook) continue;
      surface_.place(v, step->target.position, step->target.sample);
      note(*step, *outlook, v);
    }
  }

  // The step that flips the edge, if that is allowed and brings its faces closer to the boundary.
  std::optional<Step> flip_of(Edge e) const {
    const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
    if (proof_.is_fixed(mesh_.face(h)) || proof_.is_fixed(mesh_.face(o))) return std::nullopt;
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge())
      return std::nullopt;
    const Step now{{a, {state_.point(a), surface_.sample(a)}, {}, {{a, b, c}, {b, a, d}}}};
    Step step{{c, {state_.point(c), surface_.sample(c)}, {mesh_.face(h), mesh_.face(o)}, {{c, d, b}, {d, c, a}}}};
    if (deviation(step) > kBetter * deviation(now) || !is_well_shaped(step)) return std::nullopt;
    return step;
  }

  // The step that moves the vertex between its neighbours, if that is allowed and brings its faces closer.
  std::optional<Step> move_of(Vertex v) const {
    Step step{{v, {state_.point(v), surface_.sample(v)}, {}, {}}};
    Vec3 middle = Vec3::Zero();
    double count = 0;
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
      if (proof_.is_fixed(f)) return std::nullopt;
      step.gone.push_back(f);
      step.faces.push_back(state_.corners(f));
    }
    for (const Vertex w : mesh_.vertices_around_target(mesh_.halfedge(v))) {
      middle += state_.point(w);
      ++count;
    }
    const double before = deviation(step);
    Step best = step;
    best.cost = kBetter * before;
    for (const double share : kMoves) {
      const Vec3 p = state_.point(v) + share * (middle / count - state_.point(v));
      if (place(step, p, surface_.cone[v]) && step.cost < best.cost) best = step;
    }
    if (best.cost >= kBetter * before) return std::nullopt;
    return best;
  }

  // Whether a face at the vertex or at one of its neighbours has changed in the last pass.
  bool is_near_change(Vertex v) const {
    const auto around = mesh_.vertices_around_target(mesh_.halfedge(v));
    return changed_[v.idx()] || std::any_of(around.begin(), around.end(), [&](Vertex w) { return changed_[w.idx()]; });
  }

  // The step that collapses the edge, unless it is not allowed or leaves too much.
  std::optional<Step> collapse_of(Edge e) const {
    const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
    Step step;
    step.at = a;
    for (const Vertex v : {a, b}) {
      for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
        if (proof_.is_fixed(f)) return std::nullopt;
        FaceCorners corners = state_.corners(f);
        if (has(corners, a) && has(corners, b)) {
          if (v == a) step.gone.push_back(f);
          continue;
        }
        step.gone.push_back(f);
        std::replace(corners.begin(), corners.end(), b, a);
        step.faces.push_back(corners);
      }
    }
    if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) return std::nullopt;
    const Vec3 middle = 0.5 * (state_.point(a) + state_.point(b));
    if (!place(step, middle, surface_.cone[a])) return std::nullopt;
    return step;
  }

  // Finds where the step's vertex deviates least, near `p`. Returns whether that is allowed.
  bool place(Step& step, const Vec3& p, Index hint) const {
    step.target = project_to_boundary(field_, p, hint, kTolerance, 0);
    const double most = most_deviation(field_.radius_at(step.target.sample.cone, step.target.sample.t));
    const Vec3 way = step.target.sample.gradient.normalized();
    std::vector<std::pair<double, double>> deviations;  // on the boundary, and by how much they grow with the height
    visit_samples(step, [&](double share, double distance, double) { deviations.emplace_back(distance, share); });
    const auto worst = [&](double height) {
      double result = std::abs(height);
      for (const auto& [distance, share] : deviations) result = std::max(result, std::abs(distance + share * height));
      return result;
    };
    double best = 0, least = worst(0);
    for (int i = -kHeights; i <= kHeights; ++i) {
      const double height = kShareForSamples * most * i / kHeights, w = worst(height);
      if (w < least) {
        least = w;
        best = height;
      }
    }
    if (least > kShareForSamples * most) return false;
    step.target.position += best * way;
    step.target.sample = field_.sample_fast(step.target.position, step.target.sample.cone);
    step.cost = deviation(step);
    return step.cost <= kShareForSamples && is_well_shaped(step);
  }

  // The largest of the step's vertex and of its faces, in limits.
  double deviation(const Step& step) const {
    const FieldSample& s = step.target.sample;
    double result = std::abs(s.distance) / most_deviation(field_.radius_at(s.cone, s.t));
    visit_samples(
        step, [&](double, double distance, double limit) { result = std::max(result, std::abs(distance) / limit); });
    return result;
  }

  double most_deviation(double radius) const { return std::min(limit_.at(radius), kMostDeviation * radius); }

  // Calls visit(share of the vertex in the point, signed distance, limit) for points of the new faces.
  template <class Visit>
  void visit_samples(const Step& step, Visit&& visit) const {
    const Vec3& p = step.target.position;
    const double radius = field_.radius_at(step.target.sample.cone, step.target.sample.t);
    for (const FaceCorners& f : step.faces) {
      const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), step.at) - f.begin());
      const Vertex b = f[(at + 1) % 3], c = f[(at + 2) % 3];
      const double limit = most_deviation(std::min({radius, surface_.radius(b), surface_.radius(c)}));
      const auto offer = [&](double share, const Vec3& q, Vertex near) {
        visit(share, field_.sample_fast(q, surface_.cone[near]).distance, limit);
      };
      offer(1.0 / 3, (p + state_.point(b) + state_.point(c)) / 3, b);
      offer(0.5, 0.5 * (p + state_.point(b)), b);
    }
  }

  bool is_well_shaped(const Step& step) const {
    const Landing landing(step.target);
    const Elongation at_target = longest_({step.target.sample.cone, step.target.sample.t});
    double worst = kWorstShape;
    bool known = false;  // how bad the faces are that are replaced
    for (const FaceCorners& f : step.faces) {
      const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), step.at) - f.begin());
      const Vertex b = f[(at + 1) % 3], c = f[(at + 2) % 3];
      if (state_.agreement(landing, b, c) < SweepState::kMinAgreement) return false;
      const double skewness = least_skewness({step.target.position, state_.point(b), state_.point(c)},
                                             {at_target, elongation_[b.idx()], elongation_[c.idx()]});
      if (skewness <= worst) continue;
      if (known) return false;
      known = true;
      for (const Face g : step.gone) worst = std::max(worst, skewness_of(g));
      if (skewness > worst) return false;
    }
    return true;
  }

  double skewness_of(Face f) const {
    const auto [a, b, c] = state_.corners(f);
    return least_skewness({state_.point(a), state_.point(b), state_.point(c)},
                          {elongation_[a.idx()], elongation_[b.idx()], elongation_[c.idx()]});
  }

  Vertex collapse(Edge e, const Step& step, const KeptProof::Outlook& outlook) {
    const Vertex v = CGAL::Euler::collapse_edge(e, mesh_);
    surface_.place(v, step.target.position, step.target.sample);
    note(step, outlook, v);
    return v;
  }

  // After a step. `at`: its vertex, as it is called now.
  void note(const Step& step, const KeptProof::Outlook& outlook, Vertex at) {
    elongation_[at.idx()] = longest_({surface_.cone[at], surface_.t[at]});
    for (const auto& [x, corner] : outlook.corners) changed_[(x == step.at ? at : x).idx()] = 1;
    proof_.note(step, outlook, at);
  }

  using Entry = std::pair<double, Index>;

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  SweepState state_;
  const VesselField& field_;
  KeptProof proof_;
  const ErrorLimit& limit_;
  const std::function<Elongation(const CenterlineBinding&)>& longest_;
  const Progress& progress_;
  double done_ = 0;
  std::size_t polls_ = 0;
  std::vector<Elongation> elongation_;  // by vertex
  std::vector<char> changed_;           // in this pass, vertices whose faces have changed
};

// Whether the surface is a manifold, so that it can be worked on.
bool build(const FinishedSurface& from, BoundSurface& surface) {
  for (Index v = 0; v < from.mesh.vertices.size(); ++v) {
    const Vec3& p = from.mesh.vertices[v];
    FieldSample sample = surface.field.sample_fast(p, from.binding[v].segment);
    sample.cone = from.binding[v].segment;
    sample.t = from.binding[v].t;
    surface.place(surface.mesh.add_vertex(p), p, sample);
  }
  for (const auto& [a, b, c] : from.mesh.faces) {
    if (surface.mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) == SurfaceMesh::null_face()) return false;
  }
  for (const Opening& opening : from.openings) {
    std::vector<Vertex> loop;
    for (const Index v : opening.ring) loop.emplace_back(v);
    surface.close_with_lid(loop, opening.center);
  }
  return true;
}

}  // namespace

void coarsen(FinishedSurface& surface, const VesselField& field, const ErrorLimit& limit,
             const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress) {
  BoundSurface work(field);
  if (!build(surface, work)) return;
  work.guard_crossings();
  Coarsener(work, limit, longest, progress).run();
  GenerateResult result;
  const std::vector<Index> number = work.export_to(result);
  surface.mesh = std::move(result.mesh);
  surface.binding = std::move(result.binding);
  surface.radius = std::move(result.radius);
  for (Opening& opening : surface.openings) {
    for (Index& v : opening.ring) v = number[v];
  }
}

}  // namespace vmesh
