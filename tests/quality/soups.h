#pragma once

#include "draw.h"
#include "shapes.h"

namespace vmesh::testing {

/// Triangles scattered in a cube, each with its own corners; one in three without area.
inline TriMesh random_soup(Draw& draw, Index faces, double size) {
  TriMesh mesh;
  for (Index f = 0; f < faces; ++f) {
    const Vec3 center = draw.in_cube(1);
    for (int i = 0; i < 3; ++i) mesh.vertices.push_back(center + draw.in_cube(size));
    if (draw.chance(0.2)) mesh.vertices.back() = 2 * mesh.vertices[3 * f] - mesh.vertices[3 * f + 1];  // a segment
    if (draw.chance(0.1)) mesh.vertices[3 * f + 2] = mesh.vertices[3 * f + 1] = mesh.vertices[3 * f];  // a point
    mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return mesh;
}

/// Every face with corners of its own.
inline TriMesh exploded(const TriMesh& mesh) {
  TriMesh soup;
  for (const Triangle& face : mesh.faces) {
    const auto first = static_cast<Index>(soup.vertices.size());
    for (const Index v : face) soup.vertices.push_back(mesh.vertices[v]);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// A rotation by 0.7 about (1, 2, 3).
inline Eigen::Matrix3d some_rotation() { return Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(); }

inline TriMesh transformed(TriMesh mesh, const Eigen::Matrix3d& by) {
  for (Vec3& v : mesh.vertices) v = (by * v).eval();
  return mesh;
}

/// Vertices moved at random.
inline TriMesh shaken(TriMesh mesh, Draw& draw, double by) {
  for (Vec3& v : mesh.vertices) v += draw.in_cube(by);
  return mesh;
}

}  // namespace vmesh::testing
