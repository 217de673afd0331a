#include "surface/paper/geodesic_sphere.h"

#include <map>

namespace vmesh {
namespace {

TriMesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

TriMesh refine(const TriMesh& coarse) {
  TriMesh fine{coarse.vertices, {}};
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [entry, added] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(fine.vertices.size()));
    if (added) fine.vertices.push_back(coarse.vertices[a] + coarse.vertices[b]);
    return entry->second;
  };
  for (const auto& [a, b, c] : coarse.faces) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

std::vector<Vertex> add_geodesic_sphere(BoundSurface& surface, const Vec3& center, double radius,
                                        const Eigen::Matrix3d& orientation, Index hint) {
  static const TriMesh sphere = refine(icosahedron());
  std::vector<Vertex> vertices;
  for (const Vec3& direction : sphere.vertices) {
    const Vec3 p = center + radius * (orientation * direction.normalized());
    vertices.push_back(surface.mesh.add_vertex(p));
    surface.place(vertices.back(), p, surface.field.sample(p, hint));
  }
  for (const auto& [a, b, c] : sphere.faces) surface.mesh.add_face(vertices[a], vertices[b], vertices[c]);
  return vertices;
}

}  // namespace vmesh
