#include "surface/proof/error_limit.h"

#include <tbb/parallel_for.h>

namespace vmesh {

namespace {

constexpr double kHighestShell = 0.5;  // radii: no use in looking at the other side of the vessel

}  // namespace

std::vector<Face> ErrorLimitCheck::unproven_faces(const SweepState& state) {
  const BoundSurface& surface = state.surface;
  std::vector<ErrorProof::Corner> vertices(state.mesh.num_vertices());
  for (const Vertex v : state.mesh.vertices()) {
    const double radius = surface.radius(v), most = kHighestShell * radius;
    vertices[v.idx()] = {state.point(v), surface.vertex_normal(v), std::min(limit_.at(radius), most), surface.cone[v]};
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

std::vector<UnprovenPlace> places_of(const BoundSurface& surface, const std::vector<Face>& faces) {
  const SurfaceMesh& mesh = surface.mesh;
  std::vector<char> waiting(mesh.num_faces(), 0);
  for (const Face f : faces) waiting[f.idx()] = 1;
  std::vector<UnprovenPlace> places;
  for (const Face first : faces) {
    if (!waiting[first.idx()]) continue;
    UnprovenPlace place{surface.position(mesh.target(mesh.halfedge(first))), 0};
    std::vector<Face> stack = {first};
    waiting[first.idx()] = 0;
    while (!stack.empty()) {
      const Face f = stack.back();
      stack.pop_back();
      ++place.faces;
      for (const Vertex v : mesh.vertices_around_face(mesh.halfedge(f))) {
        for (const Face next : mesh.faces_around_target(mesh.halfedge(v))) {
          if (next == SurfaceMesh::null_face() || !waiting[next.idx()]) continue;
          waiting[next.idx()] = 0;
          stack.push_back(next);
        }
      }
    }
    places.push_back(place);
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const UnprovenPlace& a, const UnprovenPlace& b) { return a.faces > b.faces; });
  return places;
}

}  // namespace vmesh
