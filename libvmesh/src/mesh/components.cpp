#include "vmesh/mesh/components.h"

#include "vmesh/core/disjoint_sets.h"
#include "vmesh/mesh/check_indices.h"

namespace vmesh {
namespace {

/// Component of every vertex, numbered by first faces; kNone for vertices without a face.
std::vector<Index> number_vertices(const TriMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.faces) {
    sets.join(a, b);
    sets.join(b, c);
  }
  std::vector<Index> number_of_root(mesh.vertices.size(), kNone), component(mesh.vertices.size(), kNone);
  Index count = 0;
  for (const Triangle& face : mesh.faces) {
    Index& number = number_of_root[sets.find(face[0])];
    if (number == kNone) number = count++;
    for (const Index v : face) component[v] = number;
  }
  return component;
}

}  // namespace

std::vector<TriMesh> split_components(const TriMesh& mesh) {
  check_indices(mesh);
  const std::vector<Index> component = number_vertices(mesh);
  std::vector<TriMesh> parts;
  for (const Triangle& face : mesh.faces) {
    if (component[face[0]] == parts.size()) parts.emplace_back();
  }
  std::vector<Index> new_index(mesh.vertices.size(), kNone);
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    if (component[v] == kNone) continue;
    TriMesh& part = parts[component[v]];
    new_index[v] = static_cast<Index>(part.vertices.size());
    part.vertices.push_back(mesh.vertices[v]);
  }
  for (const auto& [a, b, c] : mesh.faces)
    parts[component[a]].faces.push_back({new_index[a], new_index[b], new_index[c]});
  return parts;
}

TriMesh joined(const std::vector<TriMesh>& meshes) {
  TriMesh all;
  for (const TriMesh& mesh : meshes) {
    const auto offset = static_cast<Index>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.faces) all.faces.push_back({a + offset, b + offset, c + offset});
  }
  return all;
}

}  // namespace vmesh
