#include "tuning/decimation.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace vmesh {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

Mesh to_cgal(const TriMesh& mesh) {
  Mesh result;
  for (const Vec3& p : mesh.vertices) result.add_vertex(Point(p.x(), p.y(), p.z()));
  for (const auto& [a, b, c] : mesh.faces)
    result.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
  return result;
}

TriMesh from_cgal(Mesh& mesh) {
  mesh.collect_garbage();
  TriMesh result;
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    result.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const Mesh::Face_index f : mesh.faces()) {
    const Mesh::Halfedge_index h = mesh.halfedge(f);
    result.faces.push_back({mesh.source(h).idx(), mesh.target(h).idx(), mesh.target(mesh.next(h)).idx()});
  }
  return result;
}

}  // namespace

TriMesh decimated(const TriMesh& mesh, std::size_t vertices, Decimation order) {
  namespace simplification = CGAL::Surface_mesh_simplification;
  Mesh work = to_cgal(mesh);
  const std::size_t edges = 3 * vertices;  // of a closed triangle mesh, approximately
  const simplification::Count_stop_predicate<Mesh> stop(edges);
  if (order == Decimation::volume) {
    simplification::edge_collapse(work, stop);
  } else {
    const simplification::GarlandHeckbert_plane_policies<Mesh, Kernel> quadrics(work);
    simplification::edge_collapse(
        work, stop, CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(quadrics.get_placement()));
  }
  return from_cgal(work);
}

}  // namespace vmesh
