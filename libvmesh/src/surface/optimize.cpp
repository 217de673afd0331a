#include "surface/optimize.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/LU>
#include <numbers>

#include "surface/triangle_energy.h"

namespace vmesh {
namespace {

constexpr double kSplitLength = 1.35;    // in target lengths
constexpr double kCollapseLength = 0.65;
constexpr double kGradation = 0.5;       // largest slope of the size field along the surface
constexpr double kMinAgreement = 0.2;    // cosine between a face's normal and the mean gradient of its corners
constexpr double kMaxTurn = 0.5;         // cosine of the angle a face may turn in one move
constexpr double kSmallestRefinement = 0.125;

class Optimizer {
 public:
  Optimizer(BoundSurface& surface, const GenerateOptions& options)
      : surface_(surface),
        mesh_(surface.mesh),
        field_(surface.field),
        edge_per_radius_(2 * std::sin(std::numbers::pi / options.around)),
        max_center_distance_(options.max_center_distance),
        sweeps_(options.sweeps),
        size_(mesh_.add_property_map<Vertex, double>("v:size", 0.0).first) {}

  void run(const Progress& progress) {
    for (int sweep = 0; sweep < sweeps_; ++sweep) {
      const double done = static_cast<double>(sweep) / sweeps_;
      report_progress(progress, "optimize", done);
      update_sizes();
      if (done < 0.7) {
        split_long_edges();
        collapse_short_edges();
        if (sweep % 4 == 3) split_far_faces();
      }
      flip_edges(done < 0.8 ? 1.0 * (1 - done) : 0.0);
      relocate_vertices();
    }
    mesh_.remove_property_map(size_);
  }

 private:
  double length(Edge e) const { return (point(mesh_.vertex(e, 0)) - point(mesh_.vertex(e, 1))).norm(); }
  const Vec3& point(Vertex v) const { return mesh_.point(v); }
  double target_length(Edge e) const { return 0.5 * (size_[mesh_.vertex(e, 0)] + size_[mesh_.vertex(e, 1)]); }

  // The target edge length at every vertex: proportional to the radius, its slope bounded.
  void update_sizes() {
    for (const Vertex v : mesh_.vertices()) size_[v] = edge_per_radius_ * surface_.radius(v) * surface_.refinement[v];
    for (int pass = 0; pass < 3; ++pass) {
      for (const Edge e : mesh_.edges()) {
        const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
        const double slack = kGradation * length(e);
        size_[a] = std::min(size_[a], size_[b] + slack);
        size_[b] = std::min(size_[b], size_[a] + slack);
      }
    }
  }

  // Whether a face with these corners lies the right way up: along the boundary's normals.
  static double agreement(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& gradient_sum) {
    const Vec3 normal = (b - a).cross(c - a);
    const double norm = normal.norm() * gradient_sum.norm();
    return norm > 0 ? normal.dot(gradient_sum) / norm : -1;
  }
  double agreement(Vertex a, Vertex b, Vertex c) const {
    return agreement(point(a), point(b), point(c), surface_.gradient[a] + surface_.gradient[b] + surface_.gradient[c]);
  }

  void split_long_edges() {
    const auto count = static_cast<Index>(mesh_.num_edges());
    for (Index i = 0; i < count; ++i) {
      const Edge e(i);
      if (mesh_.is_removed(e) || length(e) <= kSplitLength * target_length(e)) continue;
      const double size = target_length(e);
      const Vertex v = surface_.split_edge(e);
      size_[v] = size;
      move_to_boundary(v);
    }
  }

  // Projects a new vertex; stays at the edge's midpoint when that would fold a face.
  void move_to_boundary(Vertex v) {
    const BoundaryPoint target = project_to_boundary(field_, point(v), surface_.cone[v]);
    const Vec3 gradient = target.sample.gradient.normalized();
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (agreement(target.position, point(b), point(c), gradient + surface_.gradient[b] + surface_.gradient[c]) <
          std::min(kMinAgreement, agreement(v, b, c))) {
        surface_.place(v, point(v), field_.sample(point(v), surface_.cone[v]));
        return;
      }
    }
    surface_.place(v, target.position, target.sample);
  }

  void collapse_short_edges() {
    const auto count = static_cast<Index>(mesh_.num_edges());
    for (Index i = 0; i < count; ++i) {
      const Edge e(i);
      if (mesh_.is_removed(e) || length(e) >= kCollapseLength * target_length(e)) continue;
      collapse(e);
    }
  }

  bool collapse(Edge e) {
    const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
    const BoundaryPoint target = project_to_boundary(field_, 0.5 * (point(a) + point(b)), surface_.cone[a]);
    if (!collapsible_to(a, b, target) || !collapsible_to(b, a, target)) return false;
    if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) return false;
    const double size = std::min(size_[a], size_[b]);
    const double refinement = std::min(surface_.refinement[a], surface_.refinement[b]);
    const Vertex v = CGAL::Euler::collapse_edge(e, mesh_);
    surface_.place(v, target.position, target.sample);
    surface_.refinement[v] = refinement;
    size_[v] = size;
    return true;
  }

  // Whether the faces of `v` without `other` stay upright and no edge becomes too long when `v` moves to target.
  bool collapsible_to(Vertex v, Vertex other, const BoundaryPoint& target) const {
    const Vec3 gradient = target.sample.gradient.normalized();
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (b == other || c == other) continue;
      if ((point(c) - target.position).norm() > kSplitLength * 0.5 * (size_[c] + size_[v])) return false;
      if (!stays_upright(v, b, c, target.position, gradient)) return false;
    }
    return true;
  }

  bool stays_upright(Vertex v, Vertex b, Vertex c, const Vec3& p, const Vec3& gradient) const {
    const double after = agreement(p, point(b), point(c), gradient + surface_.gradient[b] + surface_.gradient[c]);
    if (after < kMinAgreement && after < agreement(v, b, c)) return false;
    const Vec3 old_normal = (point(b) - point(v)).cross(point(c) - point(v));
    const Vec3 new_normal = (point(b) - p).cross(point(c) - p);
    return after > 0.8 || new_normal.dot(old_normal) >= kMaxTurn * new_normal.norm() * old_normal.norm();
  }

  // The paper's accuracy step: faces whose centre is too far from the boundary.
  void split_far_faces() {
    const auto count = static_cast<Index>(mesh_.num_faces());
    for (Index i = 0; i < count; ++i) {
      const Face f(i);
      if (mesh_.is_removed(f)) continue;
      const Halfedge h = mesh_.halfedge(f);
      const std::array<Vertex, 3> corner = {mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h))};
      const Vec3 center = (point(corner[0]) + point(corner[1]) + point(corner[2])) / 3;
      const FieldSample s = field_.sample(center, surface_.cone[corner[0]]);
      if (std::abs(s.distance) <= max_center_distance_ * field_.radius_at(s.cone, s.t)) continue;
      double refinement = 1;
      for (const Vertex v : corner) refinement = std::min(refinement, surface_.refinement[v]);
      refinement = std::max(kSmallestRefinement, refinement / 2);
      for (const Vertex v : corner) surface_.refinement[v] = std::min(surface_.refinement[v], refinement);
      for (const Vertex v : surface_.split_edge_centric(f)) {
        size_[v] = std::min({size_[corner[0]], size_[corner[1]], size_[corner[2]]}) / 2;
        surface_.refinement[v] = refinement;
        move_to_boundary(v);
      }
    }
  }

  static double square(double x) { return x * x; }
  double energy(Vertex a, Vertex b, Vertex c) const {
    return square(inverse_mean_ratio(point(a), point(b), point(c)));
  }
  double irregularity(Vertex v, int change) const {
    return square(static_cast<double>(mesh_.degree(v)) + change - 6);
  }

  // Flips where the two triangles' energy plus `regularity` times the valence defects falls and both stay upright.
  void flip_edges(double regularity) {
    for (const Edge e : mesh_.edges()) {
      const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
      const Vertex a = mesh_.source(h), b = mesh_.target(h);
      const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
      if (mesh_.degree(a) <= 3 || mesh_.degree(b) <= 3) continue;
      double gain = energy(a, b, c) + energy(b, a, d) - energy(c, d, b) - energy(d, c, a);
      if (regularity > 0) {
        gain += regularity * (irregularity(a, 0) + irregularity(b, 0) + irregularity(c, 0) + irregularity(d, 0) -
                              irregularity(a, -1) - irregularity(b, -1) - irregularity(c, 1) - irregularity(d, 1));
      }
      if (!(gain > 1e-9)) continue;
      const double now = std::min(agreement(a, b, c), agreement(b, a, d));
      const double then = std::min(agreement(c, d, b), agreement(d, c, a));
      if (then < 0.5 && then < now) continue;
      if (mesh_.halfedge(c, d) != SurfaceMesh::null_halfedge()) continue;
      CGAL::Euler::flip_edge(h, mesh_);
    }
  }

  void relocate_vertices() {
    for (const Vertex v : mesh_.vertices()) relocate(v);
  }

  // One Newton step of the shape energy in the tangent plane, reprojected; halved until it is an improvement.
  void relocate(Vertex v) {
    const Vec3 x = point(v);
    const Vec3 n = surface_.gradient[v];
    const Vec3 u = n.unitOrthogonal(), w = n.cross(u);
    PlanarEnergy energy;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      energy.add(x, point(mesh_.target(mesh_.next(h))), point(mesh_.source(h)), u, w);
    }
    Vec3 step = Vec3::Zero();
    if (std::isfinite(energy.value)) {
      const Eigen::Vector2d s = -energy.hessian.inverse() * energy.gradient;
      step = s.x() * u + s.y() * w;
    } else {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) step += point(mesh_.source(h)) - x;
      step /= static_cast<double>(mesh_.degree(v));
    }
    const double longest = 0.3 * size_[v], norm = step.norm();
    if (!(norm < 1e12)) return;
    if (norm > longest) step *= longest / norm;
    for (int attempt = 0; attempt < 3; ++attempt, step *= 0.5) {
      const BoundaryPoint target = project_to_boundary(field_, x + step, surface_.cone[v], 1e-3);
      if (!improves(v, target, energy.value)) continue;
      surface_.place(v, target.position, target.sample);
      return;
    }
  }

  bool improves(Vertex v, const BoundaryPoint& target, double old_energy) const {
    const Vec3 gradient = target.sample.gradient.normalized();
    double sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (!stays_upright(v, b, c, target.position, gradient)) return false;
      sum += square(inverse_mean_ratio(target.position, point(b), point(c)));
    }
    return sum < old_energy;
  }

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const VesselField& field_;
  double edge_per_radius_;
  double max_center_distance_;
  int sweeps_;
  SurfaceMesh::Property_map<Vertex, double> size_;
};

}  // namespace

void optimize(BoundSurface& surface, const GenerateOptions& options, const Progress& progress) {
  Optimizer(surface, options).run(progress);
}

}  // namespace vmesh
