#include "surface/remesh/bound_surface.h"

#include <algorithm>
#include <numeric>

#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>

#include "vmesh/core/execution.h"

namespace vmesh {
namespace {

constexpr int kMaxProjectionSteps = 12;  // safe 8 to 17
// Slope of the elongation along the surface, per radius, and how far it is followed.
constexpr double kElongationSlope = 0.5;
constexpr int kElongationPasses = 3;

FieldSample sample(const VesselField& field, const Vec3& p, Index hint, double tolerance) {
  return tolerance >= kRoughTolerance ? field.sample_fast(p, hint) : field.sample(p, hint);
}

}  // namespace

BoundaryPoint project_to_boundary(const VesselField& field, const Vec3& p, Index hint, double tolerance, double lift) {
  return project_to_boundary(field, {p, sample(field, p, hint, tolerance)}, tolerance, lift);
}

BoundaryPoint project_to_boundary(const VesselField& field, BoundaryPoint point, double tolerance, double lift) {
  for (int step = 0; step < kMaxProjectionSteps; ++step) {
    const FieldSample& s = point.sample;
    const double off = s.distance - lift;
    if (std::abs(off) <= tolerance * field.relations().radius_at(s.cone, s.t)) break;
    const double slope2 = s.gradient.squaredNorm();
    if (slope2 < 0.01) break;  // on an axis, or in the valley between two blended cones: no direction to follow
    point.position -= off / slope2 * s.gradient;
    point.sample = sample(field, point.position, s.cone, tolerance);
  }
  return point;
}

BoundVertex BoundVertex::between(const BoundVertex& a, const BoundVertex& b) {
  BoundVertex middle;
  middle.cone = a.cone;
  middle.t = a.t;
  middle.gradient = (a.gradient + b.gradient).normalized();
  middle.lift = 0.5 * (a.lift + b.lift);
  middle.fineness = 0.5 * (a.fineness + b.fineness);
  middle.size = 0.5 * (a.size + b.size);
  middle.elongation = 0.5 * (a.elongation + b.elongation);
  middle.elongation_share = 0.5 * (a.elongation_share + b.elongation_share);
  return middle;
}

BoundVertex BoundVertex::merged(const BoundVertex& a, const BoundVertex& b) {
  BoundVertex one = between(a, b);
  one.fineness = std::min(a.fineness, b.fineness);
  one.size = std::min(a.size, b.size);
  one.elongation_share = std::min(a.elongation_share, b.elongation_share);
  return one;
}

BoundSurface::BoundSurface(const VesselField& vessel_field)
    : field(vessel_field), vertex_(mesh.add_property_map<Vertex, BoundVertex>("v:bound").first) {}

bool BoundSurface::is_lid(Face f) const {
  const auto [a, b, c] = corners(f);
  return vertex_[a].role == Role::lid || vertex_[b].role == Role::lid || vertex_[c].role == Role::lid;
}

void BoundSurface::close_with_lid(const std::vector<Vertex>& loop, const Vec3& center) {
  const Vertex middle = mesh.add_vertex(center);
  place(middle, center, field.sample(center, vertex_[loop.front()].cone));
  vertex_[middle].role = Role::lid;
  for (std::size_t j = 0; j < loop.size(); ++j) {
    vertex_[loop[j]].role = Role::held;
    mesh.add_face(loop[j], loop[(j + 1) % loop.size()], middle);
  }
}

void BoundSurface::place(Vertex v, const Vec3& p, const FieldSample& sample) {
  mesh.point(v) = p;
  BoundVertex& at = vertex_[v];
  at.cone = sample.cone;
  at.t = sample.t;
  at.gradient = sample.gradient.normalized();
  at.distance = sample.distance;
  touch_faces(v);
}

void BoundSurface::update_elongation() {
  if (!elongation_field) return;
  std::vector<double> times(mesh.num_vertices(), 1.0);
  bool shortened = false;
  for (const Vertex v : mesh.vertices()) {
    BoundVertex& at = vertex_[v];
    const Elongation full = elongation_field->elongation_at(at.cone, at.t);
    times[v.idx()] = 1 + at.elongation_share * (full.times - 1);
    at.elongation = full.direction;
    shortened = shortened || at.elongation_share < 1;
  }
  // The field is graded by itself.
  for (int pass = 0; shortened && pass < kElongationPasses; ++pass) {
    for (const Edge e : mesh.edges()) {
      const Vertex a = mesh.vertex(e, 0), b = mesh.vertex(e, 1);
      const double way = (mesh.point(a) - mesh.point(b)).norm();
      const double most = kElongationSlope * way / std::min(radius(a), radius(b));
      double &of_a = times[a.idx()], &of_b = times[b.idx()];
      of_a = std::min(of_a, of_b + most);
      of_b = std::min(of_b, of_a + most);
    }
  }
  for (const Vertex v : mesh.vertices())
    vertex_[v].elongation = ElongatedMetric::vector(vertex_[v].elongation, times[v.idx()]);
}

void BoundSurface::guard_crossings(Axes kept) {
  std::vector<Index> cones;
  if (kept == Axes::all) {
    cones.resize(field.relations().centerline().segments().size());
    std::iota(cones.begin(), cones.end(), Index{0});
  } else if (kept == Axes::bound) {
    for (const Vertex v : mesh.vertices()) cones.push_back(vertex_[v].cone);
    std::sort(cones.begin(), cones.end());
    cones.erase(std::unique(cones.begin(), cones.end()), cones.end());
  }
  std::vector<CrossingGuard::AxisLine> axes;
  for (const Index c : cones) {
    const Vec3 from = field.relations().axis_point(c, 0), to = field.relations().axis_point(c, 1);
    if (from != to) axes.push_back({from, to});
  }
  guard_ = std::make_unique<CrossingGuard>(
      mesh.num_faces(), [this](Index f) { return placed(Face(f)); }, std::move(axes));
}

// Nothing for removed faces and those of lids.
std::optional<PlacedFace> BoundSurface::placed(Face f) const {
  if (f.idx() >= mesh.num_faces() || mesh.is_removed(f) || is_lid(f)) return std::nullopt;
  const auto [a, b, c] = corners(f);
  return PlacedFace{{a.idx(), b.idx(), c.idx()}, {mesh.point(a), mesh.point(b), mesh.point(c)}};
}

void BoundSurface::touch_faces(Vertex v) {
  if (!guard_) return;
  for (const Face f : mesh.faces_around_target(mesh.halfedge(v))) {
    if (f != SurfaceMesh::null_face()) guard_->touch(f.idx());
  }
}

bool BoundSurface::allows(const SurfaceStep& step) const {
  if (!guard_) return true;
  std::vector<PlacedFace> faces;
  for (const std::array<Vertex, 3>& f : step.faces) {
    PlacedFace& face = faces.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      face.vertices[k] = f[k].idx();
      face.points[k] = f[k] == step.vertex ? step.target.position : mesh.point(f[k]);
    }
  }
  return guard_->allows(faces, {step.gone.begin(), step.gone.end()});
}

SurfaceStep BoundSurface::moving(Vertex v, const BoundaryPoint& target) const {
  SurfaceStep step{v, target, {}, {}};
  for (const Face f : mesh.faces_around_target(mesh.halfedge(v))) {
    step.gone.push_back(f);
    if (!is_lid(f)) step.faces.push_back(corners(f));
  }
  return step;
}

SurfaceStep BoundSurface::collapsing(Vertex a, Vertex b, const BoundaryPoint& target) const {
  SurfaceStep step{a, target, {}, {}};
  for (const Vertex end : {a, b}) {
    for (const Face f : mesh.faces_around_target(mesh.halfedge(end))) {
      std::array<Vertex, 3> face = corners(f);
      const bool has_both = std::count_if(face.begin(), face.end(), [&](Vertex v) { return v == a || v == b; }) == 2;
      if (!has_both || end == a) step.gone.push_back(f);
      if (has_both || is_lid(f)) continue;
      std::replace(face.begin(), face.end(), b, a);
      step.faces.push_back(face);
    }
  }
  return step;
}

SurfaceStep BoundSurface::flipping(Halfedge h) const {
  const Halfedge o = mesh.opposite(h);
  const Vertex a = mesh.source(h), b = mesh.target(h);
  const Vertex c = mesh.target(mesh.next(h)), d = mesh.target(mesh.next(o));
  return {c, {position(c), sample(c)}, {mesh.face(h), mesh.face(o)}, {{c, d, b}, {d, c, a}}};
}

SurfaceStep BoundSurface::splitting(Edge e) const {
  const Vertex added = SurfaceMesh::null_vertex();
  SurfaceStep step{added, {middle_of(mesh.halfedge(e))}, {}, {}};
  for (const Halfedge h : {mesh.halfedge(e), mesh.opposite(mesh.halfedge(e))}) {
    step.gone.push_back(mesh.face(h));
    if (is_lid(mesh.face(h))) continue;
    const Vertex apex = mesh.target(mesh.next(h));
    step.faces.push_back({mesh.source(h), added, apex});
    step.faces.push_back({added, mesh.target(h), apex});
  }
  return step;
}

bool BoundSurface::may_split_edge_centric(Face f) const {
  if (!guard_) return true;
  struct Corner {
    Index number;
    Vec3 point;
  };
  std::vector<PlacedFace> faces;
  std::vector<Index> gone = {f.idx()};
  const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
    faces.push_back({{a.number, b.number, c.number}, {a.point, b.point, c.point}});
  };
  std::array<Corner, 3> corner, middle;
  Halfedge h = mesh.halfedge(f);
  for (Index i = 0; i < 3; ++i, h = mesh.next(h)) {
    const Vertex from = mesh.source(h), to = mesh.target(h), beyond = mesh.target(mesh.next(mesh.opposite(h)));
    corner[i] = {from.idx(), mesh.point(from)};
    middle[i] = {kNone - i, middle_of(h)};
    gone.push_back(mesh.face(mesh.opposite(h)));
    if (is_lid(mesh.face(mesh.opposite(h)))) continue;
    const Corner apex{beyond.idx(), mesh.point(beyond)};
    add(middle[i], corner[i], apex);
    add({to.idx(), mesh.point(to)}, middle[i], apex);
  }
  add(middle[0], middle[1], middle[2]);
  for (std::size_t i = 0; i < 3; ++i) add(corner[i], middle[i], middle[(i + 2) % 3]);
  return guard_->allows(faces, gone);
}

void BoundSurface::place_on_boundary(Vertex v, const Vec3& p, Index hint) {
  const BoundaryPoint point = project_to_boundary(field, p, hint, 1e-6, vertex_[v].lift);
  place(v, point.position, point.sample);
}

void BoundSurface::require_closed(const std::string& what) const {
  require_invariant(mesh.is_valid(false) && CGAL::is_closed(mesh), what + " is not closed and 2-manifold");
}

Vec3 BoundSurface::face_area_normal(Face f) const {
  const Halfedge h = mesh.halfedge(f);
  const Vec3 &a = mesh.point(mesh.source(h)), &b = mesh.point(mesh.target(h)),
             &c = mesh.point(mesh.target(mesh.next(h)));
  return (b - a).cross(c - a);
}

Vec3 BoundSurface::vertex_normal(Vertex v) const {
  Vec3 normal = Vec3::Zero();
  for (const Face f : mesh.faces_around_target(mesh.halfedge(v))) normal += face_area_normal(f);
  return normal.normalized();
}

Vec3 BoundSurface::middle_normal(Vertex v) const {
  Vec3 normal = Vec3::Zero();
  for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) {
    if (!mesh.is_border(h))
      normal += angle_normal(mesh.point(v), mesh.point(mesh.target(mesh.next(h))), mesh.point(mesh.source(h)));
  }
  return normal.normalized();
}

Vertex BoundSurface::halve(Halfedge h) {
  const Vertex a = mesh.source(h), b = mesh.target(h);
  const Vec3 middle = middle_of(h);
  const Vertex v = mesh.target(CGAL::Euler::split_edge(h, mesh));
  mesh.point(v) = middle;
  vertex_[v] = BoundVertex::between(vertex_[a], vertex_[b]);
  return v;
}

Vertex BoundSurface::split_edge(Edge e) {
  const Halfedge h = mesh.halfedge(e);
  const Vertex v = halve(h);
  // halve() left h as the second half and put the first half before it: both adjacent faces are quads now.
  const Halfedge in = mesh.prev(h);
  CGAL::Euler::split_face(in, mesh.next(h), mesh);
  const Halfedge opposite_in = mesh.opposite(h);
  CGAL::Euler::split_face(opposite_in, mesh.next(mesh.opposite(in)), mesh);
  touch_faces(v);
  return v;
}

Vertex BoundSurface::collapse_edge(Edge e, const BoundaryPoint& target) {
  const BoundVertex one = BoundVertex::merged(vertex_[mesh.vertex(e, 0)], vertex_[mesh.vertex(e, 1)]);
  const Halfedge h = mesh.halfedge(e);
  const std::array<Face, 2> beside = {mesh.face(h), mesh.face(mesh.opposite(h))};
  const Vertex v = CGAL::Euler::collapse_edge(e, mesh);
  for (const Face f : beside) {
    if (guard_ && f != SurfaceMesh::null_face()) guard_->touch(f.idx());
  }
  vertex_[v] = one;
  place(v, target.position, target.sample);
  return v;
}

void BoundSurface::flip_edge(Halfedge h) {
  CGAL::Euler::flip_edge(h, mesh);
  touch_faces(mesh.target(h));
}

std::array<Vertex, 3> BoundSurface::split_edge_centric(Face f) {
  const Halfedge h0 = mesh.halfedge(f);
  const std::array<Halfedge, 3> sides = {h0, mesh.next(h0), mesh.next(mesh.next(h0))};
  std::array<Vertex, 3> middles;
  for (int i = 0; i < 3; ++i) {
    middles[i] = halve(sides[i]);
    const Halfedge in = mesh.opposite(sides[i]);  // ends at the middle, on the neighbour's side
    CGAL::Euler::split_face(in, mesh.next(mesh.next(in)), mesh);
  }
  // The face is a hexagon of corners and middles; cut its corners off.
  for (int i = 0; i < 3; ++i) {
    const Halfedge in = mesh.prev(sides[i]);  // ends at middle i; sides[i] runs on to the corner
    CGAL::Euler::split_face(in, mesh.next(mesh.next(in)), mesh);
  }
  for (const Vertex v : middles) touch_faces(v);
  return middles;
}

std::vector<Index> BoundSurface::export_to(GenerateResult& result) const {
  std::vector<Index> number(mesh.num_vertices() + mesh.number_of_removed_vertices(), kNone);
  Index next = 0;
  for (const Vertex v : mesh.vertices()) {
    if (vertex_[v].role == Role::lid) continue;
    number[v.idx()] = next++;
    result.mesh.vertices.push_back(mesh.point(v));
    result.binding.push_back({vertex_[v].cone, vertex_[v].t});
    result.radius.push_back(radius(v));
  }
  for (const Face f : mesh.faces()) {
    if (is_lid(f)) continue;
    const Halfedge h = mesh.halfedge(f);
    result.mesh.faces.push_back(
        {number[mesh.source(h).idx()], number[mesh.target(h).idx()], number[mesh.target(mesh.next(h)).idx()]});
  }
  return number;
}

}  // namespace vmesh
