#include "vmesh/mesh/tri_mesh.h"

#include <cmath>

namespace vmesh {

Vec3 angle_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double twice_area = normal.norm();
  if (twice_area == 0) return Vec3::Zero();
  return std::atan2(twice_area, (b - a).dot(c - a)) / twice_area * normal;
}

std::vector<Vec3> vertex_normals(const TriMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 normal = area_normal(mesh, f);
    for (const Index v : mesh.faces[f]) normals[v] += normal;
  }
  for (Vec3& n : normals) {
    const double norm = n.norm();
    if (norm > 0) n /= norm;
  }
  return normals;
}

}  // namespace vmesh
