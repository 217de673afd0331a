#include <algorithm>

#include "vmesh/core/box_tree.h"
#include "vmesh/mesh/topology.h"

#include "mesh/face_pair.h"

namespace vmesh {

std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh) {
  const auto placed = [&](Index f) {
    const auto& [a, b, c] = mesh.faces[f];
    return PlacedFace{mesh.faces[f], {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  std::vector<Index> faces;
  std::vector<Vec3> low, high;
  const std::vector<Index> degenerate = degenerate_faces(mesh);
  auto skipped = degenerate.begin();
  for (auto* corners : {&low, &high}) corners->reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (skipped != degenerate.end() && *skipped == f) {
      ++skipped;
      continue;
    }
    const Vec3 &a = mesh.vertices[mesh.faces[f][0]], &b = mesh.vertices[mesh.faces[f][1]],
               &c = mesh.vertices[mesh.faces[f][2]];
    faces.push_back(f);
    low.push_back(a.cwiseMin(b).cwiseMin(c));
    high.push_back(a.cwiseMax(b).cwiseMax(c));
  }
  std::vector<std::pair<Index, Index>> pairs;
  BoxTree(low, high).visit_pairs([&](Index i, Index j) {
    if ((low[i].array() > high[j].array()).any() || (low[j].array() > high[i].array()).any()) return;
    if (intersect(placed(faces[i]), placed(faces[j]))) pairs.push_back(std::minmax(faces[i], faces[j]));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace vmesh
