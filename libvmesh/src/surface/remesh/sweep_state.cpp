#include "surface/remesh/sweep_state.h"

#include <numbers>

namespace vmesh {
namespace {

// Target length in edges of a regular polygon around the vessel; safe only at this value, below vertices +12 %, above
// vertices -8 %.
constexpr double kEdgeFactor = 1.026;
constexpr double kErrorMargin = 0.87;  // safe 0.74 to 1.2, below vertices +9 %
constexpr double kGradation = 0.5;     // largest slope of the size field along the surface; safe 0.35 to 0.7
constexpr int kGradationPasses = 3;    // safe 2 to 4
constexpr double kMaxTurn = 0.5;       // cosine of the angle by which a face may turn in one move; safe 0.35 to 0.7
// Agreement with the boundary from which on it may turn by more; safe 0.56 to 1.1.
constexpr double kFreeToTurn = 0.8;
// In vessel radii: at most the first (safe 0.0007 to 0.0014), and that share of what edges cut off, which is the first
// at twelve around; but no less than single precision tells (kRoughTolerance). With an error limit, the first: finer
// ones cost proofs, as what is made before the limit is known (share .0067) cost one of 5 % on a portal vein.
constexpr double kProjectionTolerance = 1e-3, kProjectionShare = 0.029;

}  // namespace

double balanced_ring_radius(double around) {
  const double half_edge = std::sin(std::numbers::pi / around);
  return 1 + half_edge * half_edge / 4;
}

double edge_length_per_radius(double around) {
  return kEdgeFactor * balanced_ring_radius(around) * 2 * std::sin(std::numbers::pi / around);
}

// An edge of length h across a vessel of radius r cuts off h^2 / (8 r); balanced, half of that is outside.
double edge_length_for(double limit, double radius) { return kErrorMargin * std::sqrt(16 * limit * radius); }

double arrival_tolerance(const BoundSurface& surface, Vertex v) {
  const double size = surface[v].size;
  if (surface.has_limit || size == 0) return kProjectionTolerance;
  const double radius = surface.radius(v);
  return std::clamp(kProjectionShare * cut_off(size, radius) / radius, kRoughTolerance, kProjectionTolerance);
}

SweepState::SweepState(BoundSurface& bound_surface)
    : surface(bound_surface),
      mesh(surface.mesh),
      field(surface.field),
      stirred_(mesh.add_property_map<Vertex, char>("v:stirred", 0).first) {
  for (const Vertex v : mesh.vertices()) surface[v].size = 0;
}

SweepState::~SweepState() { mesh.remove_property_map(stirred_); }

BoundaryPoint SweepState::project(Vertex v) const {
  const double lift = surface[v].lift;
  const BoundaryPoint here = project_to_boundary(field, {point(v), surface.sample(v)}, tolerance(v), lift);
  const double off = std::abs(here.sample.distance - lift);
  if (off <= tolerance(v) * surface.radius(v)) return here;
  Vec3 center = Vec3::Zero();
  for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) center += point(mesh.source(h));
  const BoundaryPoint there = project(v, center / static_cast<double>(mesh.degree(v)));
  return std::abs(there.sample.distance - lift) < off ? there : here;
}

double SweepState::mean_square_edge(Face f) const {
  double mean = 0;
  const auto vertices = corners(f);
  for (int i = 0; i < 3; ++i) mean += (point(vertices[i]) - point(vertices[(i + 1) % 3])).squaredNorm() / 3;
  return mean;
}

double SweepState::off_at_middle(std::span<const Vertex> corners) const {
  const auto count = static_cast<double>(corners.size());
  Vec3 middle = Vec3::Zero();
  double at_corners = 0;
  for (const Vertex v : corners) {
    middle += point(v) / count;
    at_corners += surface[v].distance / count;
  }
  return field.sample_fast(middle, surface[corners[0]].cone).distance - at_corners;
}

void SweepState::update_sizes(double edge_per_radius, const ErrorLimit& limit) {
  surface.has_limit = limit.is_set();
  surface.update_elongation();
  for (const Vertex v : mesh.vertices()) {
    const double radius = surface.radius(v);
    double edge = edge_per_radius * radius;
    if (limit.is_set()) edge = std::min(edge, edge_length_for(limit.at(radius), radius));
    double& size = surface[v].size;
    size = edge * surface[v].fineness;
    for (const auto& [spot, spot_radius] : surface.fine_spots)
      size = std::min(size, edge_per_radius * spot_radius + kGradation * (point(v) - spot).norm());
    for (const FinePlace& place : surface.fine_places)
      size = std::min(size, place.edge + kGradation * std::max(0.0, (point(v) - place.center).norm() - place.reach));
  }
  for (int pass = 0; pass < kGradationPasses; ++pass) {
    for (const Edge e : mesh.edges()) {
      const Vertex a = mesh.vertex(e, 0), b = mesh.vertex(e, 1);
      const double slack = kGradation * (point(a) - point(b)).norm();
      double &at_a = surface[a].size, &at_b = surface[b].size;
      at_a = std::min(at_a, at_b + slack);
      at_b = std::min(at_b, at_a + slack);
    }
  }
}

void SweepState::stir(Vertex v) {
  touch(v);
  for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) touch(mesh.source(h));
}

void SweepState::stir_all() {
  for (const Vertex v : mesh.vertices()) touch(v);
}

std::size_t SweepState::next_sweep() {
  std::size_t count = 0;
  for (const Vertex v : mesh.vertices()) {
    stirred_[v] = stirred_[v] & kStirred ? kActive : 0;
    count += stirred_[v] != 0;
  }
  return count;
}

double SweepState::agreement(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& gradient_sum) {
  const Vec3 normal = (b - a).cross(c - a);
  const double norm = std::sqrt(normal.squaredNorm() * gradient_sum.squaredNorm());
  return norm > 0 ? normal.dot(gradient_sum) / norm : -1;
}

bool SweepState::stays_upright(Vertex v, Vertex b, Vertex c, const Landing& target) const {
  const double after = agreement(target, b, c);
  if (after < kMinAgreement && after < agreement(v, b, c)) return false;
  if (after > kFreeToTurn) return true;
  const Vec3 edge_b = point(b) - point(v), edge_c = point(c) - point(v);
  const Vec3 old_normal = edge_b.cross(edge_c);
  const Vec3 new_normal = (point(b) - target.position).cross(point(c) - target.position);
  return new_normal.dot(old_normal) >= kMaxTurn * new_normal.norm() * old_normal.norm();
}

}  // namespace vmesh
