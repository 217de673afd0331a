#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

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
