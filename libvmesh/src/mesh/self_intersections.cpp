#include <algorithm>

#include "vmesh/mesh/topology.h"

#include "mesh/close_faces.h"
#include "mesh/face_pair.h"

namespace vmesh {

namespace {

std::vector<Index> faces_with_area(const TriMesh& mesh) {
  const std::vector<Index> degenerate = degenerate_faces(mesh);
  std::vector<Index> faces;
  faces.reserve(mesh.faces.size());
  auto skipped = degenerate.begin();
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (skipped != degenerate.end() && *skipped == f) {
      ++skipped;
    } else {
      faces.push_back(f);
    }
  }
  return faces;
}

std::vector<std::pair<Index, Index>> intersecting(const TriMesh& mesh, const CloseFaces& close) {
  const auto placed = [&](Index f) {
    const auto& [a, b, c] = mesh.faces[f];
    return PlacedFace{mesh.faces[f], {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}};
  };
  std::vector<std::pair<Index, Index>> pairs;
  close.visit_pairs([&](Index f, Index g) {
    if (intersect(placed(f), placed(g))) pairs.push_back(std::minmax(f, g));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh) {
  return intersecting(mesh, CloseFaces(mesh, faces_with_area(mesh)));
}

std::vector<std::pair<Index, Index>> intersections_between(const TriMesh& mesh, std::span<const Index> first_face) {
  const std::vector<Index> faces = faces_with_area(mesh);
  std::vector<Index> parts;
  parts.reserve(faces.size());
  Index part = 0;
  for (const Index f : faces) {
    while (part + 1 < first_face.size() && first_face[part + 1] <= f) ++part;
    parts.push_back(part);
  }
  return intersecting(mesh, CloseFaces(mesh, faces, parts));
}

}  // namespace vmesh
