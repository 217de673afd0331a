#include <algorithm>
#include <tuple>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "vmesh/mesh/check_indices.h"
#include "vmesh/mesh/sorted_by_vertex.h"
#include "vmesh/mesh/topology.h"

#include "mesh/blocks.h"

namespace vmesh {

std::vector<Index> degenerate_faces(const TriMesh& mesh) {
  check_indices(mesh);
  using ExactPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  const auto is_degenerate = [&](const Triangle& face) {
    const Vec3 &a = mesh.vertices[face[0]], &b = mesh.vertices[face[1]], &c = mesh.vertices[face[2]];
    return CGAL::collinear(ExactPoint(a.x(), a.y(), a.z()), ExactPoint(b.x(), b.y(), b.z()),
                           ExactPoint(c.x(), c.y(), c.z()));
  };
  return joined_lists(of_blocks<std::vector<Index>>(mesh.faces.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<Index> degenerate;
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      if (is_degenerate(mesh.faces[f])) degenerate.push_back(f);
    }
    return degenerate;
  }));
}

std::vector<Index> duplicate_faces(const TriMesh& mesh) {
  check_indices(mesh);
  struct Face {
    Triangle corners;  // ascending
    Index number;
  };
  const auto visit_faces = [&](auto&& visit) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      Face face{mesh.faces[f], f};
      std::sort(face.corners.begin(), face.corners.end());
      visit(face.corners[0], face);
    }
  };
  const auto sorted = sorted_by_vertex<Face>(mesh.vertices.size(), visit_faces, [](const Face& x, const Face& y) {
    return std::tie(x.corners, x.number) < std::tie(y.corners, y.number);
  });
  std::vector<Index> duplicates;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].corners == sorted[i - 1].corners) duplicates.push_back(sorted[i].number);
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

}  // namespace vmesh
