#include "surface/check/error_limit.h"

#include <map>

#include <tbb/parallel_for.h>

#include "vmesh/core/disjoint_sets.h"

namespace vmesh {

std::vector<Face> ErrorLimitCheck::unproven_faces(const SweepState& state) {
  const BoundSurface& surface = state.surface;
  std::vector<ErrorProof::Corner> vertices(state.mesh.num_vertices());
  for (const Vertex v : state.mesh.vertices()) {
    const double shell = shell_at(limit_, surface.radius(v));
    vertices[v.idx()] = {state.point(v), surface.middle_normal(v), shell, surface[v].cone};
  }
  std::vector<Face> faces;
  std::vector<Triangle> triangles;
  for (const Face f : state.mesh.faces()) {
    const auto [a, b, c] = state.corners(f);
    if (surface.held(a) || surface.held(b) || surface.held(c)) continue;
    faces.push_back(f);
    triangles.push_back({a.idx(), b.idx(), c.idx()});
  }
  const ErrorProof proof(state.field);
  known_.resize(state.mesh.num_faces());
  std::vector<ErrorProof::Shares> shares(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
    const auto& [a, b, c] = triangles[i];
    const ErrorProof::Face face = {vertices[a], vertices[b], vertices[c]};
    Known& known = known_[faces[i].idx()];
    if (known.face != face) known = {face, proof.shares(face)};
    shares[i] = known.shares;
  });
  std::vector<Face> unproven;
  for (const Index i : proof.unproven(vertices, triangles, shares)) unproven.push_back(faces[i]);
  return unproven;
}

std::vector<UnprovenPlace> places_of(const TriMesh& mesh, const std::vector<Index>& faces) {
  std::vector<UnprovenPlace> places;
  if (faces.empty()) return places;
  DisjointSets joined(mesh.vertices.size());
  for (const Index f : faces) {
    for (const Index v : mesh.faces[f]) joined.join(mesh.faces[f][0], v);
  }
  std::map<Index, std::size_t> number;
  for (const Index f : faces) {
    const auto [it, is_new] = number.emplace(joined.find(mesh.faces[f][0]), places.size());
    if (is_new) places.push_back({mesh.vertices[mesh.faces[f][1]], 0});
    ++places[it->second].faces;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const UnprovenPlace& a, const UnprovenPlace& b) { return a.faces > b.faces; });
  return places;
}

}  // namespace vmesh
