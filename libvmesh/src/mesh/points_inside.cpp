#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include "vmesh/core/error.h"
#include "vmesh/mesh/topology.h"

namespace vmesh {

std::vector<bool> points_inside(const TriMesh& mesh, const std::vector<Vec3>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
  Surface surface;
  surface.reserve(static_cast<unsigned>(mesh.vertices.size()), static_cast<unsigned>(mesh.faces.size() * 3 / 2),
                  static_cast<unsigned>(mesh.faces.size()));
  for (const Vec3& v : mesh.vertices) surface.add_vertex({v.x(), v.y(), v.z()});
  for (const auto& [a, b, c] : mesh.faces) {
    using Vertex = Surface::Vertex_index;
    if (surface.add_face(Vertex(a), Vertex(b), Vertex(c)) == Surface::null_face()) {
      throw InvalidInput("inside is not defined: the mesh is not manifold");
    }
  }
  if (mesh.faces.empty() || !CGAL::is_closed(surface)) throw InvalidInput("inside is not defined: the mesh is open");
  const CGAL::Side_of_triangle_mesh<Surface, Kernel> side(surface);
  std::vector<bool> inside;
  inside.reserve(points.size());
  for (const Vec3& p : points) inside.push_back(side({p.x(), p.y(), p.z()}) == CGAL::ON_BOUNDED_SIDE);
  return inside;
}

}  // namespace vmesh
