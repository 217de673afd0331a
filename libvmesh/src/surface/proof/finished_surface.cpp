#include "surface/proof/finished_surface.h"

namespace vmesh {

std::vector<FinishedMesh::Step> merges(const FinishedMesh& mesh, Index v) {
  std::vector<FinishedMesh::Step> steps;
  for (const Index f : mesh.faces_around(v)) {
    const Index w = FinishedMesh::turned_to(v, mesh.faces()[f])[1];
    if (mesh.may_collapse({v, w})) steps.push_back(mesh.collapsing(v, w, mesh.vertex(w)));
  }
  return steps;
}

FinishedMesh finished_mesh(const FinishedSurface& surface) {
  std::vector<FinishedVertex> vertices;
  for (Index v = 0; v < surface.mesh.vertices.size(); ++v)
    vertices.push_back({surface.mesh.vertices[v], surface.binding[v], surface.radius[v]});
  return {surface.mesh.faces, std::move(vertices)};
}

std::vector<Index> put_back(FinishedMesh mesh, FinishedSurface& surface) {
  std::vector<Index> number = mesh.pack();
  surface.mesh = mesh.tri_mesh();
  surface.binding.clear();
  surface.radius.clear();
  for (const FinishedVertex& v : mesh.vertices()) {
    surface.binding.push_back(v.binding);
    surface.radius.push_back(v.radius);
  }
  for (Opening& opening : surface.openings) {
    for (Index& v : opening.ring) v = number[v];
  }
  for (Index& v : surface.held) v = number[v];
  return number;
}

}  // namespace vmesh
