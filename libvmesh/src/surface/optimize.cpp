#include "surface/optimize.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/LU>
#include <numbers>
#include <queue>

#include "surface/triangle_energy.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

constexpr double kSplitLength = 1.35;    // in target lengths
constexpr double kCollapseLength = 0.65;
constexpr double kEdgeFactor = 1.08;     // target length in edges of a regular polygon around the vessel
constexpr double kGrownAround = 6;
constexpr double kGradation = 0.5;       // largest slope of the size field along the surface
constexpr double kMinAgreement = 0.2;    // cosine between a face's normal and the mean gradient of its corners
constexpr double kMaxTurn = 0.5;         // cosine of the angle a face may turn in one move
constexpr double kMaxBulge = 0.3;        // see bulge()
constexpr double kOffBoundary = 0.01;     // vessel radii
constexpr double kBadEnergy = 1.8;        // squared inverse mean ratio; skewness about 0.4
constexpr double kNoticeableMove = 0.02; // in target lengths, for the neighbours to be looked at again
constexpr double kHopeless = 0.02;       // share of the vertices in tangles
constexpr int kLooseRings = 2;
constexpr int kLoosePasses = 5;

class Optimizer {
 public:
  Optimizer(BoundSurface& surface, const GenerateOptions& options)
      : surface_(surface),
        mesh_(surface.mesh),
        field_(surface.field),
        around_(options.around),
        max_center_distance_(options.max_center_distance),
        sweeps_(options.sweeps),
        size_(mesh_.add_property_map<Vertex, double>("v:size", 0.0).first),
        stirred_(mesh_.add_property_map<Vertex, char>("v:stirred", kActive | kStirred).first) {}

  // From the resolution of the grown mesh to the one asked for, doubling at most: an even mesh is refined or
  // coarsened safely, a grown one is not.
  void run(const Progress& progress) {
    for (double around = kGrownAround; around != around_; around = std::min<double>(2 * around, around_)) {
      set_resolution(around);
      sweep(0, progress, "optimize");
      if (loosen_tangles() > 0) sweep(sweeps_ / 2, progress, "optimize");
    }
    set_resolution(around_);
    sweep(0, progress, "optimize");
    std::size_t before = std::numeric_limits<std::size_t>::max();
    for (std::size_t tangled = loosen_tangles(); tangled > 0 && tangled < before; tangled = loosen_tangles()) {
      before = tangled;
      sweep(sweeps_ / 2, progress, "untangle");
    }
    mesh_.remove_property_map(size_);
    mesh_.remove_property_map(stirred_);
  }

 private:
  static constexpr char kActive = 1, kStirred = 2;

  void set_resolution(double around) {
    edge_per_radius_ = kEdgeFactor * 2 * std::sin(std::numbers::pi / around);
    for (const Vertex v : mesh_.vertices()) stirred_[v] = kActive | kStirred;
  }

  // Sweeps from number `first` on: first towards the size field, then for shape alone.
  void sweep(int first, const Progress& progress, const char* stage) {
    bool split_far = false;
    for (int sweep = first; sweep < sweeps_; ++sweep) {
      const double done = static_cast<double>(sweep) / sweeps_;
      report_progress(progress, stage, done);
      update_sizes();
      if (next_active() == 0) break;
      if (done < 0.7) {
        if (sweep % 4 == 0) repair_strays();
        split_long_edges();
        collapse_short_edges();
      }
      if (done >= 0.7 && !split_far) {
        split_far_faces();
        split_far = true;
      }
      if (done >= 0.7) collapse_bad_faces();
      flip_edges(done < 0.8 ? 1.0 * (1 - done) : 0.0);
      relocate_vertices();
    }
  }

  // Only what changed in the last sweep, and its neighbours, is looked at in the next one.
  bool active(Vertex v) const { return stirred_[v] & kActive; }
  bool active(Edge e) const { return active(mesh_.vertex(e, 0)) || active(mesh_.vertex(e, 1)); }

  void stir(Vertex v) {
    stirred_[v] |= kStirred;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) stirred_[mesh_.source(h)] |= kStirred;
  }

  std::size_t next_active() {
    std::size_t count = 0;
    for (const Vertex v : mesh_.vertices()) {
      stirred_[v] = stirred_[v] & kStirred ? kActive : 0;
      count += stirred_[v] != 0;
    }
    return count;
  }

  double length(Edge e) const { return (point(mesh_.vertex(e, 0)) - point(mesh_.vertex(e, 1))).norm(); }
  const Vec3& point(Vertex v) const { return mesh_.point(v); }
  double target_length(Edge e) const { return 0.5 * (size_[mesh_.vertex(e, 0)] + size_[mesh_.vertex(e, 1)]); }

  // The target edge length at every vertex: proportional to the radius, its slope bounded.
  void update_sizes() {
    for (const Vertex v : mesh_.vertices()) size_[v] = edge_per_radius_ * surface_.radius(v);
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

  // Longest first, relative to the target: a chord over a bend must be halved before anything nestles against it.
  void split_long_edges() {
    std::priority_queue<std::pair<double, Index>> queue;
    const auto push = [&](Edge e, double limit = std::numeric_limits<double>::infinity()) {
      const double excess = length(e) / target_length(e);
      if (excess > kSplitLength && excess < limit && upright(e)) queue.emplace(excess, e.idx());
    };
    for (const Edge e : mesh_.edges()) {
      if (active(e)) push(e);
    }
    while (!queue.empty()) {
      const auto [excess, index] = queue.top();
      queue.pop();
      const Edge e(index);
      if (length(e) / target_length(e) != excess) continue;  // has changed since, and was pushed again
      const Vertex v = split(e);
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
        push(mesh_.edge(h), 0.99 * excess);  // shorter each time: this ends
        try_flip(mesh_.edge(mesh_.prev(h)), 0);
      }
    }
  }

  // Folded faces are not refined: there is no telling where their new vertices belong.
  bool upright(Edge e) const {
    for (const Halfedge h : {mesh_.halfedge(e), mesh_.opposite(mesh_.halfedge(e))}) {
      if (agreement(mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h))) < kMinAgreement) return false;
    }
    return true;
  }

  Vertex split(Edge e) {
    const double size = target_length(e);
    const Vertex v = surface_.split_edge(e);
    size_[v] = size;
    stirred_[v] = kActive;
    stir(v);
    move_to_boundary(v);
    return v;
  }

  // Projects a new vertex; stays at the edge's midpoint when that would fold a face.
  void move_to_boundary(Vertex v) {
    const BoundaryPoint target = project_to_boundary(field_, point(v), surface_.cone[v]);
    const Vec3 gradient = target.sample.gradient.normalized();
    const bool far = (target.position - point(v)).norm() > size_[v];
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (far || agreement(target.position, point(b), point(c), gradient + surface_.gradient[b] + surface_.gradient[c]) <
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
      if (mesh_.is_removed(e) || !active(e) || length(e) >= kCollapseLength * target_length(e)) continue;
      collapse(e);
    }
  }

  bool collapse(Edge e) {
    const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
    const BoundaryPoint target = project_to_boundary(field_, 0.5 * (point(a) + point(b)), surface_.cone[a]);
    if (!collapsible_to(a, b, target) || !collapsible_to(b, a, target)) return false;
    if (!CGAL::Euler::does_satisfy_link_condition(e, mesh_)) return false;
    const double size = std::min(size_[a], size_[b]);
    const Vertex v = CGAL::Euler::collapse_edge(e, mesh_);
    surface_.place(v, target.position, target.sample);
    size_[v] = size;
    stir(v);
    return true;
  }

  // A bad face that no flip and no move mends goes away with its shortest edge, if what is left is better.
  void collapse_bad_faces() {
    const auto count = static_cast<Index>(mesh_.num_faces());
    for (Index i = 0; i < count; ++i) {
      const Face f(i);
      if (mesh_.is_removed(f)) continue;
      const auto [a, b, c] = corners(f);
      if (energy(a, b, c) < kBadEnergy) continue;
      Halfedge shortest = mesh_.halfedge(f);
      for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(f))) {
        if (length(mesh_.edge(h)) < length(mesh_.edge(shortest))) shortest = h;
      }
      const Vertex u = mesh_.source(shortest), v = mesh_.target(shortest);
      const BoundaryPoint target = project_to_boundary(field_, 0.5 * (point(u) + point(v)), surface_.cone[u]);
      const double worst = std::max(worst_energy(u, v, target.position), worst_energy(v, u, target.position));
      if (worst < energy(a, b, c)) collapse(mesh_.edge(shortest));
    }
  }

  // The largest energy of the faces of `v` without `other` after a move of `v` to `p`.
  double worst_energy(Vertex v, Vertex other, const Vec3& p) const {
    double worst = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (b != other && c != other) worst = std::max(worst, square(inverse_mean_ratio(p, point(b), point(c))));
    }
    return worst;
  }

  // Whether the faces of `v` without `other` stay upright and no edge becomes too long when `v` moves to target.
  bool collapsible_to(Vertex v, Vertex other, const BoundaryPoint& target) const {
    const Vec3 gradient = target.sample.gradient.normalized();
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (b == other || c == other) continue;
      if ((point(c) - target.position).norm() > kSplitLength * 0.5 * (size_[c] + size_[v])) return false;
      if (!stays_upright(v, b, c, target.position, gradient)) return false;
      const double reach = (point(c) - target.position).norm();
      if (std::abs(field_.sample(0.5 * (point(c) + target.position), target.sample.cone).distance) > kMaxBulge * reach) {
        return false;
      }
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

  std::array<Vertex, 3> corners(Face f) const {
    const Halfedge h = mesh_.halfedge(f);
    return {mesh_.source(h), mesh_.target(h), mesh_.target(mesh_.next(h))};
  }

  // The paper's accuracy step: faces whose centre is too far from the boundary.
  void split_far_faces() {
    const auto count = static_cast<Index>(mesh_.num_faces());
    for (Index i = 0; i < count; ++i) {
      const Face f(i);
      if (mesh_.is_removed(f)) continue;
      const std::array<Vertex, 3> corner = corners(f);
      const Vec3 center = (point(corner[0]) + point(corner[1]) + point(corner[2])) / 3;
      const FieldSample s = field_.sample(center, surface_.cone[corner[0]]);
      if (std::abs(s.distance) <= max_center_distance_ * field_.radius_at(s.cone, s.t)) continue;
      for (const Vertex v : surface_.split_edge_centric(f)) {
        size_[v] = std::min({size_[corner[0]], size_[corner[1]], size_[corner[2]]}) / 2;
        stirred_[v] = kActive;
        stir(v);
        move_to_boundary(v);
      }
    }
  }

  // How far the edge ab strays from the boundary at its middle, in edge lengths: about length / (8 r) where it
  // follows a vessel round, more where it cuts a corner or bridges a crotch.
  double bulge(Vertex a, Vertex b) const {
    const Vec3 middle = 0.5 * (point(a) + point(b));
    return std::abs(field_.sample(middle, surface_.cone[a]).distance) / (point(a) - point(b)).norm();
  }

  // Edges that bridge a crotch or cut through a vessel are flipped out of it, or split so that their middle can go
  // where it belongs.
  void repair_strays() {
    const auto count = static_cast<Index>(mesh_.num_edges());
    for (Index i = 0; i < count; ++i) {
      const Edge e(i);
      if (mesh_.is_removed(e) || !active(e)) continue;
      const Vertex a = mesh_.vertex(e, 0), b = mesh_.vertex(e, 1);
      const double stray = bulge(a, b);
      if (stray < kMaxBulge) continue;
      const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
      const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
      if (can_flip(h) && bulge(c, d) < 0.5 * stray && flip_stays_upright(a, b, c, d)) {
        flip(h);
      } else if (getenv("SPL") && length(e) > kCollapseLength * target_length(e)) {
        split(e);
      }
    }
  }

  bool can_flip(Halfedge h) const {
    const Halfedge o = mesh_.opposite(h);
    if (mesh_.degree(mesh_.source(h)) <= 3 || mesh_.degree(mesh_.target(h)) <= 3) return false;
    return mesh_.halfedge(mesh_.target(mesh_.next(h)), mesh_.target(mesh_.next(o))) == SurfaceMesh::null_halfedge();
  }

  // Whether the faces left and right of ab, with apexes c and d, may be exchanged for those of cd.
  bool flip_stays_upright(Vertex a, Vertex b, Vertex c, Vertex d) const {
    const double then = std::min(agreement(c, d, b), agreement(d, c, a));
    return then >= 0.5 || then >= std::min(agreement(a, b, c), agreement(b, a, d));
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
      if (active(e)) try_flip(e, regularity);
    }
  }

  void flip(Halfedge h) {
    for (const Halfedge side : {h, mesh_.opposite(h)}) {
      stirred_[mesh_.target(side)] |= kStirred;
      stirred_[mesh_.target(mesh_.next(side))] |= kStirred;
    }
    CGAL::Euler::flip_edge(h, mesh_);
  }

  bool try_flip(Edge e, double regularity) {
    const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
    const Vertex a = mesh_.source(h), b = mesh_.target(h);
    const Vertex c = mesh_.target(mesh_.next(h)), d = mesh_.target(mesh_.next(o));
    double gain = energy(a, b, c) + energy(b, a, d) - energy(c, d, b) - energy(d, c, a);
    if (regularity > 0) {
      gain += regularity * (irregularity(a, 0) + irregularity(b, 0) + irregularity(c, 0) + irregularity(d, 0) -
                            irregularity(a, -1) - irregularity(b, -1) - irregularity(c, 1) - irregularity(d, 1));
    }
    if (!(gain > 1e-9)) return false;
    if (!can_flip(h) || !flip_stays_upright(a, b, c, d)) return false;
    const double stray = bulge(c, d);
    if (stray > kMaxBulge && stray > bulge(a, b)) return false;
    flip(h);
    return true;
  }

  void relocate_vertices() {
    for (const Vertex v : mesh_.vertices()) {
      if (active(v)) relocate(v);
    }
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
      if ((target.position - x).norm() > size_[v] || !improves(v, target, energy.value)) continue;
      if (off_boundary(v) || (target.position - x).norm() > kNoticeableMove * size_[v]) stir(v);
      surface_.place(v, target.position, target.sample);
      return;
    }
  }

  // A vertex that is not on the boundary yet must get there, at any price in shape that keeps its faces upright.
  bool off_boundary(Vertex v) const { return std::abs(surface_.distance[v]) > kOffBoundary * surface_.radius(v); }

  bool improves(Vertex v, const BoundaryPoint& target, double old_energy) const {
    if (off_boundary(v)) old_energy = std::numeric_limits<double>::infinity();
    const Vec3 gradient = target.sample.gradient.normalized();
    double sum = 0;
    for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
      const Vertex b = mesh_.target(mesh_.next(h)), c = mesh_.source(h);
      if (!stays_upright(v, b, c, target.position, gradient)) return false;
      sum += square(inverse_mean_ratio(target.position, point(b), point(c)));
    }
    return sum < old_energy;
  }

  // Finds faces that intersect although their vessels are neighbours, and lets their surroundings relax like a
  // rubber sheet on the boundary, which pulls folds flat. Returns how many vertices they had, 0 where
  // they are too many: then growth covered vessels twice, and no local operation helps.
  std::size_t loosen_tangles() {
    std::vector<Vertex> region = tangled_vertices();
    const std::size_t count = region.size();
    if (count > kHopeless * static_cast<double>(mesh_.number_of_vertices())) return 0;
    for (int ring = 0; ring < kLooseRings; ++ring) grow_region(region);
    for (int pass = 0; pass < kLoosePasses; ++pass) {
      for (const Vertex v : region) {
        Vec3 center = Vec3::Zero();
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) center += point(mesh_.source(h));
        center /= static_cast<double>(mesh_.degree(v));
        const BoundaryPoint target = project_to_boundary(field_, center, surface_.cone[v]);
        if ((target.position - center).norm() < size_[v]) surface_.place(v, target.position, target.sample);
      }
    }
    for (const Vertex v : region) stir(v);
    return count;
  }

  std::vector<Vertex> tangled_vertices() const {
    TriMesh mesh;
    std::vector<Face> face_of;
    mesh.vertices.assign(mesh_.points().begin(), mesh_.points().end());
    for (const Face f : mesh_.faces()) {
      const auto [a, b, c] = corners(f);
      mesh.faces.push_back({a.idx(), b.idx(), c.idx()});
    }
    std::vector<Vertex> vertices;
    for (const Vertex v : mesh_.vertices()) {
      if (off_boundary(v)) vertices.push_back(v);
    }
    for (const auto& [f, g] : self_intersections(mesh)) {
      if (!neighbours(mesh.faces[f], mesh.faces[g])) continue;
      for (const Index face : {f, g}) {
        for (const Index v : mesh.faces[face]) vertices.emplace_back(v);
      }
    }
    sort_unique(vertices);
    return vertices;
  }

  bool neighbours(const Triangle& f, const Triangle& g) const {
    for (const Index v : f) {
      const auto local = field_.local_cones(surface_.cone[Vertex(v)]);
      for (const Index w : g) {
        if (std::binary_search(local.begin(), local.end(), surface_.cone[Vertex(w)])) return true;
      }
    }
    return false;
  }

  static void sort_unique(std::vector<Vertex>& vertices) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }

  void grow_region(std::vector<Vertex>& region) const {
    const std::size_t count = region.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(region[i]))) region.push_back(mesh_.source(h));
    }
    sort_unique(region);
  }

  BoundSurface& surface_;
  SurfaceMesh& mesh_;
  const VesselField& field_;
  int around_;
  double edge_per_radius_ = 0;
  double max_center_distance_;
  int sweeps_;
  SurfaceMesh::Property_map<Vertex, double> size_;
  SurfaceMesh::Property_map<Vertex, char> stirred_;
};

}  // namespace

void optimize(BoundSurface& surface, const GenerateOptions& options, const Progress& progress) {
  Optimizer(surface, options).run(progress);
}

}  // namespace vmesh
