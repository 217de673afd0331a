#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "vmesh/mesh/triangle_energy.h"

#include "surface/remesh/bound_surface.h"
#include "surface/remesh/edge_lengths.h"

namespace vmesh {

/// Where a vertex may go, and the boundary's normal there.
struct Landing {
  explicit Landing(const BoundaryPoint& point) : position(point.position), normal(point.sample.gradient.normalized()) {}

  const Vec3 position, normal;
};

/// Distance from its lift at which a projected vertex has arrived, in vessel radii.
double arrival_tolerance(const BoundSurface& surface, Vertex v);

/// What the steps of a sweep share: the surface, its size field, and which vertices are active.
class SweepState {
 public:
  explicit SweepState(BoundSurface& bound_surface);
  ~SweepState();
  SweepState(const SweepState&) = delete;
  SweepState& operator=(const SweepState&) = delete;

  BoundSurface& surface;
  SurfaceMesh& mesh;
  const VesselField& field;

  const Vec3& point(Vertex v) const { return mesh.point(v); }
  /// Length in the surface's metric.
  double length(Edge e) const {
    const Vertex a = mesh.vertex(e, 0);
    return length(a, mesh.vertex(e, 1), point(a));
  }
  /// That of the edge ab once a has moved to `p`.
  double length(Vertex a, Vertex b, const Vec3& p) const {
    const Vec3 way = p - point(b);
    return surface.elongation_field ? surface.metric(a, b).length(way) : way.norm();
  }
  /// How far `v` would go to `p`, in the metric.
  double away(Vertex v, const Vec3& p) const {
    const Vec3 way = p - point(v);
    return surface.elongation_field ? ElongatedMetric(surface[v].elongation).length(way) : way.norm();
  }
  /// Of a face, mm^2.
  double mean_square_edge(Face f) const;
  /// How far the middle of an edge or a face is off the boundary, towards the outside, more than its corners are, mm.
  double off_at_middle(std::span<const Vertex> corners) const;
  /// Target edge length at a vertex, mm; 0 before update_sizes().
  double size(Vertex v) const { return surface[v].size; }
  double target_length(Edge e) const { return 0.5 * (size(mesh.vertex(e, 0)) + size(mesh.vertex(e, 1))); }
  std::array<Vertex, 3> corners(Face f) const { return surface.corners(f); }

  /// Sets the size field: `edge_per_radius` times the local radius but no more than `limit` allows on a vessel, times
  /// the vertex's fineness, its slope along the surface bounded.
  void update_sizes(double edge_per_radius, const ErrorLimit& limit = {});

  // Whether `v` is to be visited in this sweep: it or a neighbour changed in the last one.
  bool active(Vertex v) const { return stirred_[v] & kActive; }
  bool active(Edge e) const { return active(mesh.vertex(e, 0)) || active(mesh.vertex(e, 1)); }
  bool active(Face f) const {
    const auto [a, b, c] = corners(f);
    return active(a) || active(b) || active(c);
  }
  /// `v` has changed: it and its neighbours are active in the next sweep.
  void stir(Vertex v);
  /// `v` alone is active in the next sweep.
  void touch(Vertex v) { stirred_[v] |= kStirred; }
  /// `v` is new: it is active in this sweep already.
  void activate(Vertex v) { stirred_[v] |= kActive; }
  void stir_all();
  /// Begins a sweep. Returns how many vertices are active.
  std::size_t next_sweep();

  /// Cosine between the normal of the face abc and the boundary's mean normal at its corners: whether it lies the
  /// right way up. -1 for a degenerate face.
  double agreement(Vertex a, Vertex b, Vertex c) const {
    return agreement(point(a), point(b), point(c), surface[a].gradient + surface[b].gradient + surface[c].gradient);
  }
  /// The same once `v` has moved to `target`.
  double agreement(const Landing& target, Vertex b, Vertex c) const {
    return agreement(target.position, point(b), point(c), target.normal + surface[b].gradient + surface[c].gradient);
  }
  /// Least agreement at which a face counts as upright.
  static constexpr double kMinAgreement = 0.2;  // safe 0.14 to 0.28

  /// Whether the face vbc stays upright and does not turn far when `v` moves to `target`.
  bool stays_upright(Vertex v, Vertex b, Vertex c, const Landing& target) const;

  /// Squared inverse mean ratio, in the surface's metric: 1 equilateral.
  double energy(Vertex a, Vertex b, Vertex c) const { return energy(a, b, c, point(a)); }
  /// That of abc once `a` has moved to `p`.
  double energy(Vertex a, Vertex b, Vertex c, const Vec3& p) const {
    if (!surface.elongation_field) return squared_inverse_mean_ratio(p, point(b), point(c));
    return elongated_energy(p, point(b), point(c), surface.metric(a, b, c));
  }
  static double elongated_energy(const Vec3& a, const Vec3& b, const Vec3& c, const ElongatedMetric& metric) {
    if (metric.is_plain()) return squared_inverse_mean_ratio(a, b, c);
    return squared_inverse_mean_ratio(Vec3::Zero(), metric.shrunk(b - a), metric.shrunk(c - a));
  }

  /// Whether `v` is not yet where it belongs, at its lift from the boundary.
  bool off_boundary(Vertex v) const {
    return std::abs(surface[v].distance - surface[v].lift) > kOffBoundary * surface.radius(v);
  }

  /// Where `v` belongs when it is moved to `p`.
  BoundaryPoint project(Vertex v, const Vec3& p) const {
    return project_to_boundary(field, p, surface[v].cone, tolerance(v), surface[v].lift);
  }
  /// Where `v` belongs near its present position; where the field has no slope there, near its neighbours' centroid.
  BoundaryPoint project(Vertex v) const;
  /// Where the vertex belongs to which `a` and `b` would collapse.
  BoundaryPoint project_middle(Vertex a, Vertex b) const {
    return project_to_boundary(field, 0.5 * (point(a) + point(b)), surface[a].cone, tolerance(a),
                               0.5 * (surface[a].lift + surface[b].lift));
  }

 private:
  static constexpr char kActive = 1, kStirred = 2;
  // Vessel radii; safe 0.007 to 0.014. A fourteenth of what edges cut off at six around, eighteen times that at 96: it
  // tells a vertex that hangs somewhere from one that has arrived; how near that is, tolerance() tells.
  static constexpr double kOffBoundary = 0.01;

  double tolerance(Vertex v) const { return arrival_tolerance(surface, v); }

  static double agreement(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& gradient_sum);

  SurfaceMesh::Property_map<Vertex, char> stirred_;
};

}  // namespace vmesh
