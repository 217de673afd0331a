#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::testing {

/// A sphere of latitude rings, faces outward.
inline TriMesh make_sphere(double radius, const Vec3& center = Vec3::Zero(), Index slices = 48) {
  const Index rings = slices / 2;
  TriMesh mesh;
  for (Index i = 0; i <= rings; ++i) {
    for (Index j = 0; j < slices; ++j) {
      const double polar = std::numbers::pi * i / rings, around = 2 * std::numbers::pi * j / slices;
      mesh.vertices.push_back(center + radius * Vec3(std::sin(polar) * std::cos(around),
                                                     std::sin(polar) * std::sin(around), std::cos(polar)));
    }
  }
  for (Index i = 0; i < rings; ++i) {
    for (Index j = 0; j < slices; ++j) {
      const Index a = i * slices + j, b = i * slices + (j + 1) % slices, c = a + slices, d = b + slices;
      if (i > 0) mesh.faces.push_back({a, c, b});
      if (i + 1 < rings) mesh.faces.push_back({b, c, d});
    }
  }
  return mesh;
}

/// The square [-1, 1]^2 in the plane y = 0, in two faces, seen from the front.
inline TriMesh make_square() { return {{{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}}; }

inline TriMesh turned_inside_out(TriMesh mesh) {
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  return mesh;
}

inline void append(TriMesh& mesh, const TriMesh& other) {
  const auto offset = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.faces) mesh.faces.push_back({a + offset, b + offset, c + offset});
}

}  // namespace vmesh::testing
