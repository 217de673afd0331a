#include <algorithm>

#include "vmesh/mesh/topology.h"

#include "mesh/close_faces.h"
#include "mesh/face_pair.h"

namespace vmesh {

std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh) {
  const auto placed = [&](Index f) {
    const auto& [a, b, c] = mesh.faces[f];
    return PlacedFace{mesh.faces[f], {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  const std::vector<Index> degenerate = degenerate_faces(mesh);
  std::vector<Index> faces;
  auto skipped = degenerate.begin();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (skipped != degenerate.end() && *skipped == f) {
      ++skipped;
    } else {
      faces.push_back(f);
    }
  }
  std::vector<std::pair<Index, Index>> pairs;
  CloseFaces(mesh, std::move(faces)).visit_pairs([&](Index f, Index g) {
    if (intersect(placed(f), placed(g))) pairs.push_back(std::minmax(f, g));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace vmesh
