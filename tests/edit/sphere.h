#pragma once

#include "vmesh/edit/edit_mesh.h"

#include "../mesh/shapes.h"

namespace vmesh::testing {

struct PlainVertex {
  Vec3 position = Vec3::Zero();
  bool operator==(const PlainVertex& other) const { return position == other.position; }
};

using PlainMesh = EditMesh<PlainVertex>;

inline PlainMesh plain_mesh(const TriMesh& mesh) {
  std::vector<PlainVertex> vertices;
  for (const Vec3& p : mesh.vertices) vertices.push_back({p});
  return {mesh.faces, vertices};
}

inline Vec3 middle_of(const PlainMesh& mesh, const MeshEdge& e) {
  return 0.5 * (mesh.position(e.a) + mesh.position(e.b));
}

}  // namespace vmesh::testing
