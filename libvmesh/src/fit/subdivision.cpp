#include "fit/subdivision.h"

#include <array>
#include <map>
#include <vector>

namespace vmesh::fitting {
namespace {

// The vertices added in the middle of inner edges, by the edge with its smaller end first.
std::map<MeshEdge, Index> add_middles(const FitMesh& surface, std::vector<FitVertex>& vertices) {
  std::map<MeshEdge, Index> middles;
  for (const MeshEdge& e : surface.edges()) {
    if (!surface.is_inner(e)) continue;
    middles[e] = static_cast<Index>(vertices.size());
    const FitVertex &a = surface.vertex(e.a), &b = surface.vertex(e.b);
    vertices.push_back(FitVertex::between(a, b, 0.5 * (a.position + b.position)));
  }
  return middles;
}

// `middle`: of the side after each corner, kNone on the border.
void divide(const Triangle& face, const std::array<Index, 3>& middle, std::vector<Triangle>& faces) {
  std::vector<Index> ring;
  for (std::size_t i = 0; i < 3; ++i) {
    ring.push_back(face[i]);
    if (middle[i] != kNone) ring.push_back(middle[i]);
  }
  if (ring.size() == 6) {
    faces.push_back(middle);
    for (std::size_t i = 0; i < 3; ++i) faces.push_back({face[i], middle[i], middle[(i + 2) % 3]});
    return;
  }
  // From a middle, or the only face: none of the triangles has three corners on one side.
  std::size_t first = 0;
  while (first < ring.size() && ring.size() > 3 && has_corner(face, ring[first])) ++first;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    faces.push_back({ring[first], ring[(first + i) % ring.size()], ring[(first + i + 1) % ring.size()]});
}

}  // namespace

void subdivide(FitMesh& surface) {
  std::vector<FitVertex> vertices = surface.vertices();
  const std::map<MeshEdge, Index> middles = add_middles(surface, vertices);
  std::vector<Triangle> faces;
  for (const Triangle& face : surface.faces()) {
    std::array<Index, 3> middle;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto found = middles.find({std::min(face[i], face[(i + 1) % 3]), std::max(face[i], face[(i + 1) % 3])});
      middle[i] = found == middles.end() ? kNone : found->second;
    }
    divide(face, middle, faces);
  }
  for (FitVertex& v : vertices) {
    v.size /= 2;
    v.base_size /= 2;
  }
  surface = FitMesh(std::move(faces), std::move(vertices));
}

}  // namespace vmesh::fitting
