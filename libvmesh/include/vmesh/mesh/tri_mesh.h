#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

using Triangle = std::array<Index, 3>;

/// An indexed triangle mesh. Faces are counter-clockwise seen from outside. Positions in mm.
struct TriMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> faces;
};

/// One number per vertex or per face, under a name ("radius", "segment", "EquiangleSkewness" ...).
struct MeshAttribute {
  std::string name;
  std::vector<double> values;
  bool integer = false;  ///< the values are integers (labels, indices) and are stored as such
};

/// The attributes of a mesh in files, in file order.
struct MeshAttributes {
  std::vector<MeshAttribute> vertex;  ///< each as long as TriMesh::vertices
  std::vector<MeshAttribute> face;    ///< each as long as TriMesh::faces
  /// Names of the patches to which the face attribute ModelFaceID assigns faces, from 1; empty: they have none.
  std::vector<std::string> patch_names = {};
};

/// Normal of face `f`, its length twice the face's area (mm^2).
inline Vec3 area_normal(const TriMesh& mesh, Index f) {
  const auto& [a, b, c] = mesh.faces[f];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

/// Normal of the triangle `a`, `b`, `c`, its length the angle at `a`; zero without an area. The sum around a vertex
/// does not depend on how walls are divided into triangles: on a crease it points midway between them (Thuermer and
/// Wuethrich 1998, Computing vertex normals from polygonal facets).
Vec3 angle_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// Unit normal of every vertex, area-weighted over its faces; zero where a vertex has no area around it.
std::vector<Vec3> vertex_normals(const TriMesh& mesh);

}  // namespace vmesh
