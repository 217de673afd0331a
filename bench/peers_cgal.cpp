#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "peers.h"

namespace vmesh::bench {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

TriMesh to_tri_mesh(const Mesh& mesh) {
  TriMesh result;
  std::vector<Index> number(mesh.num_vertices() + mesh.number_of_removed_vertices());
  for (const auto v : mesh.vertices()) {
    number[v] = static_cast<Index>(result.vertices.size());
    const Kernel::Point_3& p = mesh.point(v);
    result.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : mesh.faces()) {
    Triangle triangle;
    std::size_t i = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f))) triangle[i++] = number[v];
    result.faces.push_back(triangle);
  }
  return result;
}

}  // namespace

struct CgalMesh::Surface {
  Mesh mesh;
};

CgalMesh::CgalMesh(const TriMesh& mesh) : surface_(std::make_unique<Surface>()) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::vector<std::size_t>> faces;
  for (const auto& [a, b, c] : mesh.faces) faces.push_back({a, b, c});
  PMP::repair_polygon_soup(points, faces);
  PMP::orient_polygon_soup(points, faces);
  PMP::polygon_soup_to_polygon_mesh(points, faces, surface_->mesh);
}

CgalMesh::~CgalMesh() = default;

TriMesh CgalMesh::decimated(double share) const {
  Mesh mesh = surface_->mesh;
  SMS::edge_collapse(mesh, SMS::Count_ratio_stop_predicate<Mesh>(share));
  mesh.collect_garbage();
  return to_tri_mesh(mesh);
}

TriMesh CgalMesh::quadric_decimated(double share) const {
  Mesh mesh = surface_->mesh;
  const SMS::GarlandHeckbert_plane_policies<Mesh, Kernel> quadrics(mesh);
  SMS::edge_collapse(mesh, SMS::Count_ratio_stop_predicate<Mesh>(share),
                     CGAL::parameters::get_cost(quadrics.get_cost()).get_placement(quadrics.get_placement()));
  mesh.collect_garbage();
  return to_tri_mesh(mesh);
}

TriMesh CgalMesh::mesh() const { return to_tri_mesh(surface_->mesh); }

double CgalMesh::bounded_error_hausdorff(const CgalMesh& to, double tolerance) const {
  return PMP::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(surface_->mesh, to.surface_->mesh, tolerance);
}

}  // namespace vmesh::bench
