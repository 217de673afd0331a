// What `vmesh tradeoff` shows, with CGAL's Mesh_3 on the same field as one more curve. Writes PREFIX.md and PREFIX.svg.
// Usage: bench_tradeoff PREFIX [CENTERLINE]; without a centerline the synthetic portal vein of 1,560 vertices.
#include "vmesh/tuning/tradeoff.h"

#include <chrono>
#include <cstdio>
#include <fstream>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
#include <CGAL/make_mesh_3.h>

#include "vmesh/centerline/synthetic_tree.h"
#include "vmesh/io/centerline_io.h"
#include "vmesh/volume/vessel_field.h"

namespace {

using namespace vmesh;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

// Facets as long as an edge of a polygon around the thinnest vessel, as far off as its sagitta, 30 degrees at least.
TriMesh mesh_3(const Centerline& centerline, double around) {
  const VesselField field(centerline, 0);
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
  // The size follows the vessels, as that of vmesh does.
  const auto edge = [&](const Kernel::Point_3& p, int, const Domain::Index&) {
    const FieldSample s = field.sample_global({p.x(), p.y(), p.z()});
    return 2 * std::sin(M_PI / around) * field.radius_at(s.cone, s.t);
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

void add_mesh_3(std::vector<TradeoffPoint>& points, const Centerline& centerline) {
  for (const int around : {4, 6, 8, 12}) {
    TradeoffPoint point;
    point.curve = "CGAL Mesh_3";
    point.setting = std::to_string(around) + " around";
    const auto begin = std::chrono::steady_clock::now();
    const TriMesh mesh = mesh_3(centerline, around);
    point.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    measure_tradeoff_point(point, mesh, centerline);
    points.push_back(point);
  }
}

void write_markdown(const std::string& file, const std::vector<TradeoffPoint>& points) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + file);
  std::fprintf(
      out,
      "| curve | setting | seconds | vertices | skewness mean | max | error mean, mm | rms | max | mean, radii "
      "| rms | max | sound |\n|--|--|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--|\n");
  for (const TradeoffPoint& p : points)
    std::fprintf(out, "| %s | %s | %.3f | %zu | %.3f | %.3f | %.4f | %.4f | %.3f | %.4f | %.4f | %.3f | %s |\n",
                 p.curve.c_str(), p.setting.c_str(), p.seconds, p.vertices, p.skewness_mean, p.skewness_max,
                 p.error_mean_mm, p.error_rms_mm, p.error_max_mm, p.error_mean_relative, p.error_rms_relative,
                 p.error_max_relative, p.sound ? "yes" : "no");
  std::fprintf(out,
               "\n| theirs | vertices | ours | vertices at the same maximum error, ratio | mean error with as many "
               "vertices, ratio | mean skewness, ratio |\n|--|--:|--|--:|--:|--:|\n");
  for (const char* theirs : {"marching cubes", "marching cubes, decimated", "CGAL Mesh_3"}) {
    for (const char* ours : {"around, blend 0", "max-error"}) {
      for (const CurveComparison& c : compare_curves(points, ours, theirs))
        std::fprintf(out, "| %s | %zu | %s | %.2f | %.2f | %.2f |\n", theirs, c.theirs.vertices, ours,
                     c.our_vertices / static_cast<double>(c.theirs.vertices),
                     c.our_error_mean_mm / c.theirs.error_mean_mm, c.our_skewness_mean / c.theirs.skewness_mean);
    }
  }
  std::fclose(out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_tradeoff PREFIX [CENTERLINE]\n");
    return 2;
  }
  const std::string prefix = argv[1];
  const Centerline centerline = argc > 2 ? load_centerline(argv[2]).cleaned.centerline : synthetic_tree();
  TradeoffOptions options;
  options.generate.threads = 1;
  std::vector<TradeoffPoint> points = sweep_tradeoff(centerline, options);
  add_mesh_3(points, centerline);
  mark_best(points);
  write_markdown(prefix + ".md", points);
  std::ofstream(prefix + ".svg") << plot_tradeoff(points);
}
