#include "surface/remesh/untangle.h"

#include "vmesh/core/ascending.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {
namespace {

constexpr int kNeighbourDepth = 2;  // layers of neighbours around a tangle that take part; safe 1 to 3
constexpr int kPasses = 5;          // safe 4 to 7
// Share of the vertices off the boundary from which on a surface hangs. Measured on 40 short thick trees with a blend
// of 2: surfaces that hung had 29 to 52 %, others at most 20 %.
constexpr double kHanging = 0.25;

bool neighbours(const BoundSurface& surface, const Triangle& f, const Triangle& g) {
  for (const Index v : f) {
    const auto local = surface.field.relations().local_cones(surface[Vertex(v)].cone);
    for (const Index w : g) {
      if (std::binary_search(local.begin(), local.end(), surface[Vertex(w)].cone)) return true;
    }
  }
  return false;
}

void add_neighbours(const SurfaceMesh& mesh, std::vector<Vertex>& region) {
  const std::size_t count = region.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(region[i]))) region.push_back(mesh.source(h));
  }
  sort_unique(region);
}

}  // namespace

TriMesh indexed_mesh(const SweepState& state, bool with_lids) {
  TriMesh mesh;
  mesh.vertices.assign(state.mesh.points().begin(), state.mesh.points().end());
  for (const Face f : state.mesh.faces()) {
    if (!with_lids && state.surface.is_lid(f)) continue;
    const auto [a, b, c] = state.corners(f);
    mesh.faces.push_back({a.idx(), b.idx(), c.idx()});
  }
  return mesh;
}

std::vector<Vertex> find_crossing_walls(const SweepState& state) {
  const TriMesh mesh = indexed_mesh(state, false);
  std::vector<Vertex> vertices;
  for (const auto& [f, g] : self_intersections(mesh)) {
    for (const Index face : {f, g}) {
      for (const Index v : mesh.faces[face]) vertices.emplace_back(v);
    }
  }
  sort_unique(vertices);
  return vertices;
}

std::vector<Vertex> find_strays(const SweepState& state) {
  std::vector<Vertex> vertices;
  for (const Vertex v : state.mesh.vertices()) {
    if (state.off_boundary(v) && !state.surface.held(v)) vertices.push_back(v);
  }
  return vertices;
}

bool hangs(const SweepState& state, const std::vector<Vertex>& strays) {
  return static_cast<double>(strays.size()) > kHanging * static_cast<double>(state.mesh.number_of_vertices());
}

std::vector<Vertex> find_tangles(const SweepState& state) {
  std::vector<Vertex> vertices = find_strays(state);
  if (hangs(state, vertices)) return vertices;
  const TriMesh mesh = indexed_mesh(state, false);
  for (const auto& [f, g] : self_intersections(mesh)) {
    if (!neighbours(state.surface, mesh.faces[f], mesh.faces[g])) continue;
    for (const Index face : {f, g}) {
      for (const Index v : mesh.faces[face]) vertices.emplace_back(v);
    }
  }
  sort_unique(vertices);
  return vertices;
}

std::vector<Vertex> loosen(SweepState& state, const std::vector<Vertex>& tangles) {
  const SurfaceMesh& mesh = state.mesh;
  std::vector<Vertex> region = tangles;
  for (int depth = 0; depth < kNeighbourDepth; ++depth) add_neighbours(mesh, region);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const Vertex v : region) {
      if (state.surface.held(v)) continue;
      Vec3 center = Vec3::Zero();
      for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(v))) center += state.point(mesh.source(h));
      center /= static_cast<double>(mesh.degree(v));
      const BoundaryPoint target = state.project(v, center);
      const bool near = (target.position - center).norm() < state.size(v);
      if (near && state.surface.may_place(v, target.position)) state.surface.place(v, target.position, target.sample);
    }
  }
  for (const Vertex v : region) state.stir(v);
  return region;
}

}  // namespace vmesh
