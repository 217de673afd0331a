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
    PlanarEnergy energy{options_.power};
    Vec3 step = surface_.elongation_field ? elongated_step(v, energy) : newton_step(v, energy);
    const double before = surface_.elongation_field ? energy_around(v) : energy.value;
    if (!std::isfinite(energy.value)) {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
        step += state_.point(mesh_.source(h)) - x;
      step /= static_cast<double>(mesh_.degree(v));
    }
    const double longest = kLongestMove * state_.size(v), norm = length_of(v, step);
    if (!std::isfinite(norm)) return;
    if (norm > longest) step *= longest / norm;
    for (int attempt = 0; attempt < kAttempts; ++attempt, step *= 0.5) {
      const BoundaryPoint target = state_.project(v, x + step);
      const double way = state_.away(v, target.position);
      if (way > state_.size(v) || !improves(v, target, before) || !surface_.may_place(v, target.position)) continue;
      if (state_.off_boundary(v) || way > options_.noticeable * state_.size(v)) state_.stir(v);
      surface_.place(v, target.position, target.sample);
      return;
    }
  }

 private:
  // Of a way of `v`, in the metric.
  double length_of(Vertex v, const Vec3& way) const {
    return surface_.elongation_field ? ElongatedMetric(surface_[v].elongation).length(way) : way.norm();
  }

  // In the metric of each face.
  double energy_around(Vertex v) const {
    double sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v)))
      sum += whole_power(state_.energy(v, mesh_.target(mesh_.next(h)), mesh_.source(h)), options_.power);
    return sum;
  }

  // Adds the faces around `v` to the energy. Nothing where that is not finite.
  Vec3 newton_step(Vertex v, PlanarEnergy& energy) const {
    const Vec3 x = state_.point(v);
    const Vec3 n = surface_[v].gradient;
    const Vec3 u = n.unitOrthogonal(), w = n.cross(u);
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      energy.add(x, state_.point(mesh_.target(mesh_.next(h))), state_.point(mesh_.source(h)), u, w);
    }
    return step_in(energy, u, w);
  }

  // The same where the metric of the surface at `v` is that of space. Planes with normal n become such with a normal
  // along n stretched.
  Vec3 elongated_step(Vertex v, PlanarEnergy& energy) const {
    const ElongatedMetric metric(surface_[v].elongation);
    const Vec3 x = state_.point(v);
    const Vec3 n = metric.stretched(surface_[v].gradient).normalized();
    const Vec3 u = n.unitOrthogonal(), w = n.cross(u);
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      energy.add(Vec3::Zero(), metric.shrunk(state_.point(mesh_.target(mesh_.next(h))) - x),
                 metric.shrunk(state_.point(mesh_.source(h)) - x), u, w);
    }
    return metric.stretched(step_in(energy, u, w));
  }

  static Vec3 step_in(const PlanarEnergy& energy, const Vec3& u, const Vec3& w) {
    if (!std::isfinite(energy.value)) return Vec3::Zero();
    const Eigen::Vector2d s = -energy.hessian.inverse() * energy.gradient;
    return s.x() * u + s.y() * w;
  }

  bool improves(Vertex v, const BoundaryPoint& target, double old_energy) const {
    // A vertex that is not yet on the boundary must get there, whatever the shape, as long as its faces stay upright.
    if (state_.off_boundary(v)) old_energy = std::numeric_limits<double>::infinity();
    const Landing landing(target);
    double sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (!state_.stays_upright(v, b, c, landing)) return false;
      const double energy = state_.energy(v, b, c, target.position);
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
