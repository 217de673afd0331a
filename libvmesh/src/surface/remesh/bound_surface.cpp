#include "surface/remesh/bound_surface.h"

#include <algorithm>
#include <numeric>

#include <CGAL/boost/graph/Euler_operations.h>

namespace vmesh {
namespace {

constexpr int kMaxProjectionSteps = 12;  // safe 8 to 17
// Radii: single precision is enough for tolerances from here on; idle 7e-5 to 0.00014.
constexpr double kRoughTolerance = 1e-4;
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
    if (std::abs(off) <= tolerance * field.radius_at(s.cone, s.t)) break;
    const double slope2 = s.gradient.squaredNorm();
    if (slope2 < 0.01) break;  // on an axis, or in the valley between two blended cones: no direction to follow
    point.position -= off / slope2 * s.gradient;
    point.sample = sample(field, point.position, s.cone, tolerance);
  }
  return point;
}

BoundSurface::BoundSurface(const VesselField& vessel_field)
    : field(vessel_field),
      cone(mesh.add_property_map<Vertex, Index>("v:cone", kNone).first),
      t(mesh.add_property_map<Vertex, double>("v:t", 0.0).first),
      gradient(mesh.add_property_map<Vertex, Vec3>("v:gradient", Vec3::Zero()).first),
      distance(mesh.add_property_map<Vertex, double>("v:distance", 0.0).first),
      lift(mesh.add_property_map<Vertex, double>("v:lift", 0.0).first),
      fineness(mesh.add_property_map<Vertex, double>("v:fineness", 1.0).first),
      elongation(mesh.add_property_map<Vertex, Vec3>("v:elongation", Vec3::Zero()).first),
      elongation_share(mesh.add_property_map<Vertex, double>("v:elongation_share", 1.0).first),
      role(mesh.add_property_map<Vertex, Role>("v:role", Role::free).first) {}

bool BoundSurface::is_lid(Face f) const {
  for (const Vertex v : mesh.vertices_around_face(mesh.halfedge(f))) {
    if (role[v] == Role::lid) return true;
  }
  return false;
}

void BoundSurface::close_with_lid(const std::vector<Vertex>& loop, const Vec3& center) {
  const Vertex middle = mesh.add_vertex(center);
  place(middle, center, field.sample(center, cone[loop.front()]));
  role[middle] = Role::lid;
  for (std::size_t j = 0; j < loop.size(); ++j) {
    role[loop[j]] = Role::held;
    mesh.add_face(loop[j], loop[(j + 1) % loop.size()], middle);
  }
}

void BoundSurface::place(Vertex v, const Vec3& p, const FieldSample& sample) {
  mesh.point(v) = p;
  cone[v] = sample.cone;
  t[v] = sample.t;
  gradient[v] = sample.gradient.normalized();
  distance[v] = sample.distance;
  if (guard_) guard_->touch(v);
}

void BoundSurface::update_elongation() {
  if (!elongation_field) return;
  std::vector<double> times(mesh.num_vertices(), 1.0);
  bool shortened = false;
  for (const Vertex v : mesh.vertices()) {
    const Elongation full = elongation_field->elongation_at(cone[v], t[v]);
    times[v.idx()] = 1 + elongation_share[v] * (full.times - 1);
    elongation[v] = full.direction;
    shortened = shortened || elongation_share[v] < 1;
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
  for (const Vertex v : mesh.vertices()) elongation[v] = ElongatedMetric::vector(elongation[v], times[v.idx()]);
}

void BoundSurface::guard_crossings(Axes kept) {
  std::vector<Index> cones;
  if (kept == Axes::all) {
    cones.resize(field.centerline().segments().size());
    std::iota(cones.begin(), cones.end(), Index{0});
  } else {
    for (const Vertex v : mesh.vertices()) cones.push_back(cone[v]);
    std::sort(cones.begin(), cones.end());
    cones.erase(std::unique(cones.begin(), cones.end()), cones.end());
  }
  std::vector<CrossingGuard::AxisLine> axes;
  for (const Index c : cones) {
    const Vec3 from = field.axis_point(c, 0), to = field.axis_point(c, 1);
    if (from != to) axes.push_back({from, to});
  }
  guard_ = std::make_unique<CrossingGuard>(
      mesh, [this](Vertex v) { return role[v] == Role::lid; }, std::move(axes));
}

void BoundSurface::place_on_boundary(Vertex v, const Vec3& p, Index hint) {
  const BoundaryPoint point = project_to_boundary(field, p, hint, 1e-6, lift[v]);
  place(v, point.position, point.sample);
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

Vertex BoundSurface::halve(Halfedge h) {
  const Vertex a = mesh.source(h), b = mesh.target(h);
  const Vec3 middle = 0.5 * (mesh.point(a) + mesh.point(b));
  const Vertex v = mesh.target(CGAL::Euler::split_edge(h, mesh));
  mesh.point(v) = middle;
  cone[v] = cone[a];
  t[v] = t[a];
  fineness[v] = 0.5 * (fineness[a] + fineness[b]);
  elongation[v] = 0.5 * (elongation[a] + elongation[b]);
  elongation_share[v] = 0.5 * (elongation_share[a] + elongation_share[b]);
  lift[v] = 0.5 * (lift[a] + lift[b]);
  gradient[v] = (gradient[a] + gradient[b]).normalized();
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
    if (role[v] == Role::lid) continue;
    number[v.idx()] = next++;
    result.mesh.vertices.push_back(mesh.point(v));
    result.binding.push_back({cone[v], t[v]});
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
