#include "surface/proof/coarsening.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include <CGAL/boost/graph/Euler_operations.h>
#include <tbb/parallel_for.h>

#include "surface/proof/kept_proof.h"
#include "surface/proof/step_deviation.h"
#include "surface/remesh/least_skewness.h"

namespace vmesh {
namespace {

// Not in the surveys of libvmesh/README.md. Each was changed alone, to about 0.7 and 1.4 times its value, on a portal
// vein: with 630 vertices left, the mean error changes by at most 1.6 %; with a limit of 10 %, the vertices by at most
// 4 % unless said.
constexpr double kShareForSamples = 0.9;  // of the limit; 0.8: 13 % more vertices, 0.97: 5 % fewer
constexpr double kWorstShape = 0.75;      // skewness of a face in its metric, unless one that it replaces was worse
constexpr double kOutdated = 1.05;        // a step whose cost has grown by so much waits for its turn
constexpr double kBetter = 0.98;       // squared deviation after a step that leaves out no vertex against that before
constexpr double kToMiddle = 0.5;      // of the way to the middle of its neighbours: where a vertex may move to,
constexpr double kToNeighbour = 0.08;  // or of that to a neighbour
constexpr double kMany = 2;            // times the vertices that are to be left
constexpr int kRounds = 5;
constexpr int kRelaxations = 6;     // at the end
constexpr double kFewSteps = 0.02;  // of the vertices: not worth another round
constexpr int kPollInterval = 64;   // steps looked at, a millisecond each at most

struct Step : Replacement {
  double cost = 0;  // by how much the squared deviation grows, mm^4
};

class Coarsener {
 public:
  Coarsener(BoundSurface& surface, const CoarseningGoal& goal,
            const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress)
      : surface_(surface),
        mesh_(surface.mesh),
        state_(surface),
        field_(surface.field),
        deviation_(state_, goal.proven),
        least_vertices_(goal.least_vertices),
        longest_(longest),
        progress_(progress) {
    if (goal.proven.is_set()) proof_.emplace(state_, goal.proven);
    for (const Vertex v : mesh_.vertices()) {
      elongation_.push_back(longest_({surface_.cone[v], surface_.t[v]}));
      if (surface_.role[v] == BoundSurface::Role::lid) ++lids_;
    }
    changed_.assign(mesh_.num_vertices(), 1);
    squared_.resize(mesh_.num_faces());
    tbb::parallel_for(Index{0}, static_cast<Index>(mesh_.num_faces()), [&](Index f) {
      if (!is_fixed(Face(f))) squared_[f] = deviation_.measure(Face(f)).squared;
    });
  }

  void run() {
    for (int round = 0; round < kRounds; ++round) {
      done_ = static_cast<double>(round) / (kRounds + kRelaxations);
      if (is_few(collapse_all())) break;
      relax();
    }
    for (int round = 0; round < kRelaxations; ++round) {
      done_ = static_cast<double>(kRounds + round) / (kRounds + kRelaxations);
      if (is_few(relax())) break;
    }
  }

 private:
  // Whether no step may replace the face.
  bool is_fixed(Face f) const {
    if (proof_) return proof_->is_fixed(f);
    const FaceCorners corners = state_.corners(f);
    return std::any_of(corners.begin(), corners.end(), [&](Vertex v) { return surface_.held(v); });
  }

  // What the step would change in the proof, if there is one; nothing if the step must not be taken.
  std::optional<KeptProof::Outlook> after(const Step& step) const {
    return proof_ ? proof_->after(step) : KeptProof::Outlook{};
  }

  // So many that it matters little in which order the next ones go: steps are measured again when it is their turn, not
  // whenever something has changed around them.
  bool has_many_to_leave_out() const {
    return least_vertices_ > 0 &&
           static_cast<double>(mesh_.number_of_vertices()) > kMany * static_cast<double>(least_vertices_);
  }

  bool is_few(std::size_t steps) const {
    return static_cast<double>(steps) < kFewSteps * static_cast<double>(mesh_.number_of_vertices());
  }

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
    while (!queue.empty() && mesh_.number_of_vertices() - lids_ > least_vertices_) {
      poll();
      const auto [expected, index] = queue.top();
      queue.pop();
      const Edge e(index);
      if (mesh_.is_removed(e)) continue;
      const std::optional<Step> step = collapse_of(e);
      if (!step) continue;
      if (step->cost > expected + (kOutdated - 1) * std::abs(expected)) {
        queue.emplace(step->cost, index);
        continue;
      }
      if (!surface_.may_collapse(mesh_.vertex(e, 0), mesh_.vertex(e, 1), step->target.position)) continue;
      const std::optional<KeptProof::Outlook> outlook = after(*step);
      if (!outlook) continue;
      const Vertex v = collapse(e, *step, *outlook);
      ++count;
      if (has_many_to_leave_out()) continue;
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
        for (const Edge changed : {mesh_.edge(h), mesh_.edge(mesh_.prev(h))}) {
          if (const std::optional<Step> next = collapse_of(changed)) queue.emplace(next->cost, changed.idx());
        }
      }
    }
    return count;
  }

  // Takes steps that leave less deviation and as many vertices, so that more can go. Returns how many.
  std::size_t relax() {
    std::size_t count = 0;
    for (const Edge e : mesh_.edges()) {
      poll();
      const std::optional<Step> step = flip_of(e);
      if (!step || !surface_.may_flip(mesh_.halfedge(e))) continue;
      const std::optional<KeptProof::Outlook> outlook = after(*step);
      if (!outlook) continue;
      CGAL::Euler::flip_edge(mesh_.halfedge(e), mesh_);
      surface_.touch_faces(step->at);
      note(*step, *outlook, step->at);
      ++count;
    }
    for (const Vertex v : mesh_.vertices()) {
      poll();
      const std::optional<Step> step = move_of(v);
      if (!step || !surface_.may_place(v, step->target.position)) continue;
      const std::optional<KeptProof::Outlook> outlook = after(*step);
      if (!outlook) continue;
      surface_.place(v, step->target.position, step->target.sample);
      note(*step, *outlook, v);
      ++count;
    }
    return count;
  }

  // The step that flips the edge, if that is allowed and brings its faces closer to the boundary.
  std::optional<Step> flip_of(Edge e) const {
    const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
    if (is_fixed(mesh_.face(h)) || is_fixed(mesh_.face(o))) return std::nullopt;
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge())
      return std::nullopt;
    Step step{{c, {state_.point(c), surface_.sample(c)}, {mesh_.face(h), mesh_.face(o)}, {{c, d, b}, {d, c, a}}}};
    if (!is_allowed(step) || step.cost >= enough_gain(step)) return std::nullopt;
    return step;
  }

  // The step that moves the vertex between its neighbours, if that is allowed and brings its faces closer.
  std::optional<Step> move_of(Vertex v) const {
    Step step{{v, {state_.point(v), surface_.sample(v)}, {}, {}}};
    Vec3 middle = Vec3::Zero();
    double count = 0;
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
      if (is_fixed(f)) return std::nullopt;
      step.gone.push_back(f);
      step.faces.push_back(state_.corners(f));
    }
    const Vec3 here = state_.point(v);
    Step best = step;
    best.cost = enough_gain(step);
    const double least = best.cost;
    const auto attempt = [&](const Vec3& p) {
      if (place(step, p, surface_.cone[v]) && step.cost < best.cost) best = step;
    };
    for (const Vertex w : mesh_.vertices_around_target(mesh_.halfedge(v))) {
      attempt(here + kToNeighbour * (state_.point(w) - here));
      middle += state_.point(w);
      ++count;
    }
    attempt(here);
    attempt(here + kToMiddle * (middle / count - here));
    if (best.cost >= least) return std::nullopt;
    return best;
  }

  // What a step that leaves out no vertex must at least change.
  double enough_gain(const Step& step) const { return (kBetter - 1) * squared_before(step); }

  double squared_before(const Step& step) const {
    double sum = 0;
    for (const Face f : step.gone) sum += squared_[f.idx()];
    return sum;
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
        if (is_fixed(f)) return std::nullopt;
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
    std::optional<Step> best;
    const auto attempt = [&](const Vec3& p, Vertex near) {
      if (place(step, p, surface_.cone[near]) && (!best || step.cost < best->cost)) best.emplace(step);
    };
    attempt(0.5 * (state_.point(a) + state_.point(b)), a);
    attempt(state_.point(a), a);
    attempt(state_.point(b), b);
    return best;
  }

  // Puts the step's vertex where its faces deviate least, near `p`. Returns whether that is allowed.
  bool place(Step& step, const Vec3& p, Index hint) const {
    deviation_.place(step, p, hint, kShareForSamples);
    return is_allowed(step);
  }

  // Whether the step's faces are close enough to the boundary and well-shaped. Sets its cost.
  bool is_allowed(Step& step) const {
    if (!is_well_shaped(step)) return false;
    const StepDeviation::Measured after = deviation_.measure(step);
    step.cost = after.squared - squared_before(step);
    return after.largest <= kShareForSamples;
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
    for (const FaceCorners& f : step.faces) {
      for (const Vertex x : f) changed_[(x == step.at ? at : x).idx()] = 1;
    }
    if (proof_) proof_->note(step, outlook, at);
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(at))) {
      if (!is_fixed(f)) squared_[f.idx()] = deviation_.measure(f).squared;
    }
  }

  using Entry = std::pair<double, Index>;

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  SweepState state_;
  const VesselField& field_;
  std::optional<KeptProof> proof_;
  StepDeviation deviation_;
  std::size_t least_vertices_;
  std::size_t lids_ = 0;
  const std::function<Elongation(const CenterlineBinding&)>& longest_;
  const Progress& progress_;
  double done_ = 0;
  std::size_t polls_ = 0;
  std::vector<Elongation> elongation_;  // by vertex
  std::vector<double> squared_;         // by face: the integral of its squared deviation, mm^4
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

void coarsen(FinishedSurface& surface, const VesselField& field, const CoarseningGoal& goal,
             const std::function<Elongation(const CenterlineBinding&)>& longest, const Progress& progress) {
  BoundSurface work(field);
  if (!build(surface, work)) return;
  work.guard_crossings(BoundSurface::Axes::all);
  Coarsener(work, goal, longest, progress).run();
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
