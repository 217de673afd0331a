#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "vmesh/mesh/topology.h"

namespace vmesh {

std::vector<Index> degenerate_faces(const TriMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Index> degenerate;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 &a = mesh.vertices[mesh.faces[f][0]], &b = mesh.vertices[mesh.faces[f][1]],
               &c = mesh.vertices[mesh.faces[f][2]];
    if (CGAL::collinear(Point(a.x(), a.y(), a.z()), Point(b.x(), b.y(), b.z()), Point(c.x(), c.y(), c.z()))) {
      degenerate.push_back(f);
    }
  }
  return degenerate;
}

std::vector<Index> duplicate_faces(const TriMesh& mesh) {
  std::vector<std::pair<Triangle, Index>> sorted;
  sorted.reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    Triangle corners = mesh.faces[f];
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, f);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> duplicates;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) duplicates.push_back(sorted[i].second);
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

}  // namespace vmesh
