#pragma once

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::testing {

/// Corner of the positive octant: volume 1/6.
inline TriMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// The cube [0, 1]^3. Vertex i is at its bits (i & 1, i >> 1 & 1, i >> 2).
inline TriMesh cube() {
  TriMesh mesh;
  for (Index i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1u, i >> 1 & 1u, i >> 2);
  for (const auto& [a, b, c, d] :
       {std::array<Index, 4>{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  }
  return mesh;
}

inline TriMesh icosahedron() {
  const double g = std::numbers::phi;
  return {{{0, 1, g},
           {0, -1, g},
           {0, 1, -g},
           {0, -1, -g},
           {1, g, 0},
           {-1, g, 0},
           {1, -g, 0},
           {-1, -g, 0},
           {g, 0, 1},
           {-g, 0, 1},
           {g, 0, -1},
           {-g, 0, -1}},
          {{0, 1, 8},  {0, 9, 1},  {0, 4, 5},  {0, 8, 4},  {0, 5, 9},  {1, 7, 6},  {1, 6, 8},
           {1, 9, 7},  {2, 3, 11}, {2, 10, 3}, {2, 5, 4},  {2, 4, 10}, {2, 11, 5}, {3, 6, 7},
           {3, 10, 6}, {3, 7, 11}, {4, 8, 10}, {5, 11, 9}, {6, 10, 8}, {7, 9, 11}}};
}

/// A unit sphere of 20 * 4^levels faces.
inline TriMesh icosphere(int levels) {
  TriMesh mesh = icosahedron();
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto middle_of = [&](Index a, Index b) {
      const auto [it, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.vertices.size()));
      if (fresh) {
        const Vec3 point = 0.5 * (mesh.vertices[a] + mesh.vertices[b]);
        mesh.vertices.push_back(point);
      }
      return it->second;
    };
    std::vector<Triangle> faces;
    for (const auto& [a, b, c] : mesh.faces) {
      const Index ab = middle_of(a, b), bc = middle_of(b, c), ca = middle_of(c, a);
      faces.insert(faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
  }
  for (Vec3& v : mesh.vertices) v.normalize();
  return mesh;
}

/// A torus around the z axis of around * along quadrilaterals, split into triangles.
inline TriMesh torus(double ring_radius, double tube_radius, Index along, Index around) {
  TriMesh mesh;
  for (Index i = 0; i < along; ++i) {
    const double u = 2 * std::numbers::pi * i / along;
    for (Index j = 0; j < around; ++j) {
      const double v = 2 * std::numbers::pi * j / around;
      const double x = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(x * std::cos(u), x * std::sin(u), tube_radius * std::sin(v));
    }
  }
  const auto at = [&](Index i, Index j) { return i % along * around + j % around; };
  for (Index i = 0; i < along; ++i) {
    for (Index j = 0; j < around; ++j) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Both meshes in one, their vertices apart.
inline TriMesh operator+(TriMesh mesh, const TriMesh& other) {
  const auto offset = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.faces) mesh.faces.push_back({a + offset, b + offset, c + offset});
  return mesh;
}

inline TriMesh moved(TriMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

inline TriMesh inverted(TriMesh mesh) {
  for (Triangle& f : mesh.faces) std::swap(f[1], f[2]);
  return mesh;
}

}  // namespace vmesh::testing
