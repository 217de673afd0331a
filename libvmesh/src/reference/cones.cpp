#include "vmesh/reference/cones.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

/// Two unit vectors that form a right-handed frame with the unit vector `direction`.
std::pair<Vec3, Vec3> across(const Vec3& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  const Vec3 u = direction.cross(Vec3::Unit(least)).normalized();
  return {u, direction.cross(u)};
}

void add_ring(TriMesh& mesh, const CenterlineNode& node, const Vec3& direction, int sides) {
  const auto [u, v] = across(direction);
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    mesh.vertices.push_back(node.position + node.radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
}

/// Faces of the cone whose ring at a begins at vertex `first`; the ring at b and the cap point follow.
void add_faces(TriMesh& mesh, Index first, Index sides) {
  const Index second = first + sides, cap = second + sides;
  for (Index i = 0; i < sides; ++i) {
    const Index next = (i + 1) % sides;
    mesh.faces.push_back({first + i, first + next, second + next});
    mesh.faces.push_back({first + i, second + next, second + i});
    mesh.faces.push_back({second + i, second + next, cap});
    if (i > 0 && next > 0) mesh.faces.push_back({first, first + next, first + i});
  }
}

}  // namespace

TruncatedCones truncated_cones(const Centerline& centerline, int sides) {
  if (sides < 3 || sides > 1000)
    throw InvalidInput("truncated cones have 3 to 1000 sides, not " + std::to_string(sides));
  if (centerline.segments().empty()) throw InvalidInput("the centerline has no segment to make a truncated cone from");
  TruncatedCones cones;
  for (Index s = 0; s < centerline.segments().size(); ++s) {
    const CenterlineNode &a = centerline.node(centerline.segment(s).a), &b = centerline.node(centerline.segment(s).b);
    const Vec3 direction = (b.position - a.position).normalized();
    const auto first = static_cast<Index>(cones.mesh.vertices.size());
    add_ring(cones.mesh, a, direction, sides);
    add_ring(cones.mesh, b, direction, sides);
    cones.mesh.vertices.push_back(b.position);
    add_faces(cones.mesh, first, static_cast<Index>(sides));
    cones.radius.insert(cones.radius.end(), sides, a.radius);
    cones.radius.insert(cones.radius.end(), sides + 1, b.radius);
    cones.segment.insert(cones.segment.end(), 2 * sides + 1, s);
  }
  return cones;
}

}  // namespace vmesh
