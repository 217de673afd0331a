#include "surface/proof/coarsening_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <CGAL/boost/graph/Euler_operations.h>
#include <tbb/parallel_for.h>

#include "surface/remesh/least_skewness.h"

namespace vmesh {
namespace {

// Not in the surveys of libvmesh/README.md. Each was changed alone, to about 0.7 and 1.4 times its value, on a portal
// vein: with 630 vertices left, the mean error changes by at most 1.6 %; with a limit of 10 %, the vertices by at most
// 4 % unless said.
constexpr double kShareForSamples = 0.9;  // of the limit; 0.8: 13 % more vertices, 0.97: 5 % fewer
constexpr double kBetter = 0.98;  // deviation after a step that leaves out no vertex against that before; 0.9: 4 % more
constexpr double kToMiddle = 0.5;      // of the way to the middle of its neighbours: where a vertex may move to,
constexpr double kToNeighbour = 0.08;  // or of that to a neighbour

}  // namespace

CoarseningSteps::CoarseningSteps(const SweepState& state, const ErrorLimit& limit, const LongestAt& longest,
                                 double worst_skewness, std::function<bool(Face)> is_fixed)
    : state_(state),
      surface_(state.surface),
      mesh_(state.mesh),
      measure_(state, limit),
      longest_(longest),
      worst_skewness_(worst_skewness),
      has_limit_(limit.is_set()),
      is_fixed_(std::move(is_fixed)) {
  for (const Vertex v : mesh_.vertices()) elongation_.push_back(longest_at(v));
  deviation_.resize(mesh_.num_faces());
  tbb::parallel_for(Index{0}, static_cast<Index>(mesh_.num_faces()), [&](Index f) {
    if (!is_fixed_(Face(f))) deviation_[f] = measure_.measure(Face(f));
  });
}

std::optional<CoarseningStep> CoarseningSteps::collapse(Edge e) const {
  const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
  CoarseningStep step{surface_.collapsing(a, b, {})};
  if (replaces_fixed(step)) return std::nullopt;
  if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) return std::nullopt;
  StepDeviation::Fan fan = measure_.fan_of(step, kShareForSamples);
  std::optional<BoundaryPoint> best;
  double least = 0;
  const auto attempt = [&](const Vec3& p, Vertex near) {
    step.target = measure_.place(fan, p, surface_[near].cone);
    if (!measure(step, fan) || (best && step.cost >= least)) return;
    best = step.target;
    least = step.cost;
  };
  attempt(0.5 * (state_.point(a) + state_.point(b)), a);
  attempt(state_.point(a), a);
  attempt(state_.point(b), b);
  if (!best) return std::nullopt;
  step.target = exact(*best);
  step.cost = least;
  return step;
}

std::optional<CoarseningStep> CoarseningSteps::split(Edge e) const {
  const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
  if (is_fixed_(mesh_.face(h)) || is_fixed_(mesh_.face(o))) return std::nullopt;
  const Vertex a = mesh_.source(h), b = mesh_.target(h), v = SurfaceMesh::null_vertex();
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  CoarseningStep step;
  step.vertex = v;
  step.gone = {mesh_.face(h), mesh_.face(o)};
  step.faces = {{v, b, c}, {v, c, a}, {v, a, d}, {v, d, b}};
  StepDeviation::Fan fan = measure_.fan_of(step, kShareForSamples);
  step.target = measure_.place(fan, 0.5 * (state_.point(a) + state_.point(b)), surface_[a].cone);
  if (!measure(step, fan)) return std::nullopt;
  step.target = exact(step.target);
  return step;
}

std::optional<CoarseningStep> CoarseningSteps::flip(Edge e) const {
  const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
  const Vertex a = mesh_.source(h), b = mesh_.target(h);
  const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
  if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3 || mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge())
    return std::nullopt;
  CoarseningStep step{surface_.flipping(h)};
  if (replaces_fixed(step)) return std::nullopt;
  StepDeviation::Fan fan = measure_.fan_of(step, kShareForSamples);
  if (!measure(step, fan) || step.cost >= enough_gain(step)) return std::nullopt;
  return step;
}

std::optional<CoarseningStep> CoarseningSteps::move(Vertex v) const {
  CoarseningStep step{surface_.moving(v, {state_.point(v), surface_.sample(v)})};
  if (replaces_fixed(step)) return std::nullopt;
  StepDeviation::Fan fan = measure_.fan_of(step, kShareForSamples);
  Vec3 middle = Vec3::Zero();
  double count = 0;
  const Vec3 here = state_.point(v);
  const double enough = enough_gain(step);
  std::optional<BoundaryPoint> best;
  double least = enough;
  const auto attempt = [&](const Vec3& p) {
    step.target = measure_.place(fan, p, surface_[v].cone);
    if (!measure(step, fan) || step.cost >= least) return;
    best = step.target;
    least = step.cost;
  };
  for (const Vertex w : mesh_.vertices_around_target(mesh_.halfedge(v))) {
    // With a limit, it is enough that vertices move at all: 2 % more vertices.
    if (!has_limit_) attempt(here + kToNeighbour * (state_.point(w) - here));
    middle += state_.point(w);
    ++count;
  }
  attempt(here);
  attempt(here + kToMiddle * (middle / count - here));
  if (!best) return std::nullopt;
  step.target = exact(*best);
  step.cost = least;
  return step;
}

// The deviation is measured in single precision.
BoundaryPoint CoarseningSteps::exact(const BoundaryPoint& at) const {
  return {at.position, state_.field.sample(at.position, at.sample.cone)};
}

bool CoarseningSteps::replaces_fixed(const CoarseningStep& step) const {
  return std::any_of(step.gone.begin(), step.gone.end(), is_fixed_);
}

void CoarseningSteps::note(const std::vector<Vertex>& changed) {
  elongation_.resize(std::max<std::size_t>(elongation_.size(), mesh_.num_vertices()));
  deviation_.resize(std::max<std::size_t>(deviation_.size(), mesh_.num_faces()));
  tbb::parallel_for(std::size_t{0}, changed.size(), [&](std::size_t i) {
    const Vertex v = changed[i];
    elongation_[v.idx()] = longest_at(v);
    for (const Face f : mesh_.faces_around_target(mesh_.halfedge(v))) {
      if (!is_fixed_(f)) deviation_[f.idx()] = measure_.measure(f);
    }
  });
}

// Whether the step's faces are well-shaped and close enough to the boundary. Sets its cost.
bool CoarseningSteps::measure(CoarseningStep& step, StepDeviation::Fan& fan) const {
  if (!is_well_shaped(step)) return false;
  const std::optional<double> after = measure_.measure(fan, step.target);
  if (!after) return false;
  step.cost = *after - deviation_before(step);
  return true;
}

bool CoarseningSteps::is_well_shaped(const CoarseningStep& step) const {
  const Landing landing(step.target);
  const Elongation at_target = longest_({step.target.sample.cone, step.target.sample.t});
  double worst = worst_skewness_;
  bool known = false;  // how bad the faces are that are replaced
  for (const FaceCorners& f : step.faces) {
    const auto at = static_cast<std::size_t>(std::find(f.begin(), f.end(), step.vertex) - f.begin());
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

// What a step that leaves out no vertex must at least change.
double CoarseningSteps::enough_gain(const CoarseningStep& step) const { return (kBetter - 1) * deviation_before(step); }

double CoarseningSteps::deviation_before(const CoarseningStep& step) const {
  double sum = 0;
  for (const Face f : step.gone) sum += deviation_[f.idx()];
  return sum;
}

double CoarseningSteps::skewness_of(Face f) const {
  const auto [a, b, c] = state_.corners(f);
  return least_skewness({state_.point(a), state_.point(b), state_.point(c)},
                        {elongation_[a.idx()], elongation_[b.idx()], elongation_[c.idx()]});
}

}  // namespace vmesh
