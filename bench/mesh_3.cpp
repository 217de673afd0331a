#include "mesh_3.h"

#include <functional>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
#include <CGAL/make_mesh_3.h>

#include "vmesh/volume/vessel_field.h"

namespace vmesh::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

}  // namespace

TriMesh mesh_3(const Centerline& centerline, double around, double blend) {
  const VesselField field(centerline, blend);
  double thinnest = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox3d box;
  for (const auto& node : centerline.nodes()) {
    thinnest = std::min(thinnest, node.radius);
    box.extend(node.position - Vec3::Constant(2 * node.radius));
    box.extend(node.position + Vec3::Constant(2 * node.radius));
  }
  const auto inside = [&](const Kernel::Point_3& p) { return field.sample_global({p.x(), p.y(), p.z()}).distance; };
  const Domain domain = Domain::create_implicit_mesh_domain(
      inside,
      Kernel::Iso_cuboid_3(box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()),
      CGAL::parameters::relative_error_bound = 1e-5);
  // The size follows the vessels, as in vmesh.
  const auto edge = [&](const Kernel::Point_3& p, int, const Domain::Index&) {
    const FieldSample s = field.sample_global({p.x(), p.y(), p.z()});
    return 2 * std::sin(M_PI / around) * field.relations().radius_at(s.cone, s.t);
  };
  struct Size {
    using FT = double;
    std::function<double(const Kernel::Point_3&, int, const Domain::Index&)> at;
    double operator()(const Kernel::Point_3& p, int dimension, const Domain::Index& index) const {
      return at(p, dimension, index);
    }
  };
  const double sagitta = thinnest * (1 - std::cos(M_PI / around));
  const Criteria criteria(CGAL::parameters::facet_angle = 30, CGAL::parameters::facet_size = Size{edge},
                          CGAL::parameters::facet_distance = 2 * sagitta);
  const Complex complex =
      CGAL::make_mesh_3<Complex>(domain, criteria, CGAL::parameters::no_perturb(), CGAL::parameters::no_exude());
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  CGAL::facets_in_complex_3_to_triangle_mesh(complex, surface);
  TriMesh mesh;
  for (const auto v : surface.vertices())
    mesh.vertices.emplace_back(surface.point(v).x(), surface.point(v).y(), surface.point(v).z());
  for (const auto f : surface.faces()) {
    const auto h = surface.halfedge(f);
    mesh.faces.push_back({surface.source(h).idx(), surface.target(h).idx(), surface.target(surface.next(h)).idx()});
  }
  return mesh;
}

}  // namespace vmesh::bench
