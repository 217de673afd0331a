#include "surface/remesh/relocation.h"

#include <Eigen/LU>

namespace vmesh {
namespace {

constexpr double kLongestMove = 0.3;  // in target lengths; safe 0.21 to 0.42
constexpr int kAttempts = 3;          // safe 2 to 4

class Relocator {
 public:
  Relocator(SweepState& state, const RelocationOptions& options)
      : state_(state), surface_(state.surface), mesh_(state.mesh), options_(options) {}

  // One Newton step of the shape energy in the tangent plane, reprojected; halved until it is an improvement.
  void relocate(Vertex v) {
    const Vec3 x = state_.point(v);
    const Vec3 n = surface_.gradient[v];
    const Vec3 u = n.unitOrthogonal(), w = n.cross(u);
    PlanarEnergy energy{options_.power};
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      energy.add(x, state_.point(mesh_.target(mesh_.next(h))), state_.point(mesh_.source(h)), u, w);
    }
    Vec3 step = Vec3::Zero();
    if (std::isfinite(energy.value)) {
      const Eigen::Vector2d s = -energy.hessian.inverse() * energy.gradient;
      step = s.x() * u + s.y() * w;
    } else {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
        step += state_.point(mesh_.source(h)) - x;
      step /= static_cast<double>(mesh_.degree(v));
    }
    const double longest = kLongestMove * state_.size[v], norm = step.norm();
    if (!std::isfinite(norm)) return;
    if (norm > longest) step *= longest / norm;
    for (int attempt = 0; attempt < kAttempts; ++attempt, step *= 0.5) {
      const BoundaryPoint target = state_.project(v, x + step);
      if ((target.position - x).norm() > state_.size[v] || !improves(v, target, energy.value) ||
          !surface_.may_place(v, target.position))
        continue;
      if (state_.off_boundary(v) || (target.position - x).norm() > options_.noticeable * state_.size[v]) state_.stir(v);
      surface_.place(v, target.position, target.sample);
      return;
    }
  }

 private:
  bool improves(Vertex v, const BoundaryPoint& target, double old_energy) const {
    // A vertex that is not yet on the boundary must get there, whatever the shape, as long as its faces stay upright.
    if (state_.off_boundary(v)) old_energy = std::numeric_limits<double>::infinity();
    const Landing landing(target);
    double sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (!state_.stays_upright(v, b, c, landing)) return false;
      const double energy = SweepState::energy(target.position, state_.point(b), state_.point(c));
      if (energy > options_.highest && energy > state_.energy(v, b, c)) return false;
      sum += whole_power(energy, options_.power);
    }
    return sum < old_energy;
  }

  SweepState& state_;
  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const RelocationOptions options_;
};

}  // namespace

void relocate_vertices(SweepState& state) {
  Relocator relocator(state, {});
  for (const Vertex v : state.mesh.vertices()) {
    if (state.active(v) && !state.surface.held(v)) relocator.relocate(v);
  }
}

void relocate_vertices(SweepState& state, const std::vector<Vertex>& vertices, const RelocationOptions& options) {
  Relocator relocator(state, options);
  for (const Vertex v : vertices) {
    if (!state.surface.held(v)) relocator.relocate(v);
  }
}

}  // namespace vmesh
