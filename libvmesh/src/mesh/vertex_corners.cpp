#include "mesh/vertex_corners.h"

#include <algorithm>
#include <tuple>

namespace vmesh {

VertexCorners::VertexCorners(const TriMesh& mesh)
    : first_(mesh.vertices.size() + 1, 0), corners_(3 * mesh.faces.size()) {
  for (const Triangle& face : mesh.faces) {
    for (const Index v : face) ++first_[v];
  }
  Index end = 0;
  for (Index& first : first_) first = end += first;  // for now where the corners end
  for (std::size_t f = mesh.faces.size(); f-- > 0;) {
    for (std::size_t i = 3; i-- > 0;) corners_[--first_[mesh.faces[f][i]]] = static_cast<Index>(3 * f + i);
  }
}

void list_sides(const TriMesh& mesh, const VertexCorners& corners, Index vertex, std::vector<SideAt>& sides) {
  sides.clear();
  const auto at = corners.at(vertex);
  for (Index k = 0; k < at.size(); ++k) {
    const Triangle& face = mesh.faces[at[k] / 3];
    const Index i = at[k] % 3, next = face[(i + 1) % 3], previous = face[(i + 2) % 3];
    sides.push_back({next, k, true});
    if (previous != vertex) sides.push_back({previous, k, false});
  }
  std::sort(sides.begin(), sides.end(),
            [](const SideAt& x, const SideAt& y) { return std::tie(x.other, x.corner) < std::tie(y.other, y.corner); });
}

}  // namespace vmesh
