#include <tbb/task_arena.h>

#include "vmesh/evaluation/vessel_distance.h"
#include "vmesh/quality/hausdorff.h"
#include "vmesh/quality/quality_report.h"
#include "vmesh/quality/sampled_distance.h"

#include "arrays.h"
#include "module.h"
#include "objects.h"
#include "running.h"

namespace vmesh::python {
namespace {

struct ReferenceDistance {
  Hausdorff hausdorff;
  SampledDistance from_surface, from_reference;
};

struct Evaluation {
  std::size_t vertices = 0, faces = 0;
  double area = 0;
  std::optional<double> volume;
  DefectReport defects;
  Distribution skewness, min_angle, max_angle;
  std::optional<ReferenceDistance> reference;
  std::optional<VesselDistance> vessel;
};

struct EvaluationOptions {
  std::size_t samples;
  double tolerance;
};

ReferenceDistance compare(const TriMesh& mesh, const TriMesh& reference, const EvaluationOptions& options,
                          const Progress& progress) {
  const ClosestPointIndex index(mesh), reference_index(reference);
  ReferenceDistance result;
  result.hausdorff = hausdorff(mesh, reference, {options.tolerance, progress});
  result.from_surface = sample_distance(mesh, reference_index, options.samples, progress);
  result.from_reference = sample_distance(reference, index, options.samples, progress);
  return result;
}

Evaluation evaluate(const TriMesh& mesh, const TriMesh* reference, const Centerline* centerline,
                    const EvaluationOptions& options, const Progress& progress) {
  Evaluation result;
  result.vertices = mesh.vertices.size();
  result.faces = mesh.faces.size();
  result.area = surface_area(mesh);
  FaceMeasures measures = measure_faces(mesh);
  result.skewness = summarize(std::move(measures.equiangle_skewness));
  result.min_angle = summarize(std::move(measures.min_angle_deg));
  result.max_angle = summarize(std::move(measures.max_angle_deg));
  report_progress(progress, "defects", 0);
  result.defects = find_defects(mesh);
  if (result.defects.topology.closed && result.defects.topology.oriented) result.volume = enclosed_volume(mesh);
  if (reference != nullptr) result.reference = compare(mesh, *reference, options, progress);
  if (centerline != nullptr)
    result.vessel =
        measure_vessel_distance(mesh, ClosestPointIndex(mesh), VesselField(*centerline), options.samples, progress);
  return result;
}

/// Runs `work` on a number of threads; 0: all.
template <class Work>
auto on_threads(int threads, const Work& work) {
  if (threads < 0) throw InvalidInput("threads must be >= 0");
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  return arena.execute(work);
}

void bind_distribution(py::module_& module) {
  py::class_<Distribution>(module, "Distribution", "Summary statistics of a set of numbers.")
      .def_readonly("count", &Distribution::count, "Of numbers.")
      .def_readonly("min", &Distribution::min, "The least.")
      .def_readonly("max", &Distribution::max, "The greatest.")
      .def_readonly("mean", &Distribution::mean, "Arithmetic mean.")
      .def_readonly("rms", &Distribution::rms, "Root of the mean square, about zero.")
      .def_readonly("p5", &Distribution::p5, "5 % of the numbers are below.")
      .def_readonly("p25", &Distribution::p25, "25 % of the numbers are below.")
      .def_readonly("median", &Distribution::median, "Half of the numbers are below.")
      .def_readonly("p75", &Distribution::p75, "75 % of the numbers are below.")
      .def_readonly("p95", &Distribution::p95, "95 % of the numbers are below.")
      .def_readonly("p99", &Distribution::p99, "99 % of the numbers are below.")
      .def("__repr__", [](const Distribution& d) {
        return py::str("<vmesh.Distribution of {}: {:.4g} to {:.4g}, mean {:.4g}>")
            .format(d.count, d.min, d.max, d.mean);
      });
}

void bind_topology(py::module_& module) {
  py::class_<Topology>(module, "Topology", "The topology of a mesh.")
      .def_readonly("closed", &Topology::closed, "Every edge has two faces or more.")
      .def_readonly("manifold", &Topology::manifold, "No edge has more than two faces, no vertex two fans.")
      .def_readonly("oriented", &Topology::oriented, "Neighbouring faces agree about the outside.")
      .def_readonly("outward", &Topology::outward, "Closed, oriented, and every component encloses a positive volume.")
      .def_readonly("components", &Topology::components, "Parts without a common vertex.")
      .def_readonly("boundary_edges", &Topology::boundary_edges, "Edges of one face.")
      .def_readonly("boundary_loops", &Topology::boundary_loops, "Rings of them.")
      .def_readonly("crowded_edges", &Topology::crowded_edges, "Edges with three faces or more.")
      .def_readonly("euler_characteristic", &Topology::euler_characteristic, "Vertices less edges plus faces.")
      .def_readonly("genus", &Topology::genus, "Sum over the components; 0 unless closed, manifold and oriented.");
}

void bind_distances(py::module_& module) {
  py::class_<OneSidedHausdorff>(
      module, "OneSidedHausdorff",
      "The largest distance of a point of one surface from the other: an interval that contains it, mm.")
      .def_readonly("lower", &OneSidedHausdorff::lower, "mm; the distance is at least this.")
      .def_readonly("upper", &OneSidedHausdorff::upper, "mm; the distance is at most this.")
      .def_property_readonly(
          "from_point", [](const OneSidedHausdorff& h) { return array_of(h.witness.from); },
          "(3,) mm: a point at least `lower` away from the other surface.")
      .def_property_readonly(
          "to_point", [](const OneSidedHausdorff& h) { return array_of(h.witness.to); },
          "(3,) mm: the point of the other surface closest to it.");
  py::class_<Hausdorff>(module, "Hausdorff",
                        "The Hausdorff distance of two surfaces: an interval that contains it, mm.")
      .def_property_readonly("lower", &Hausdorff::lower, "mm; the distance is at least this.")
      .def_property_readonly("upper", &Hausdorff::upper, "mm; the distance is at most this.")
      .def_readonly("forward", &Hausdorff::forward, "From the first surface to the second.")
      .def_readonly("backward", &Hausdorff::backward, "From the second surface to the first.")
      .def("__repr__", [](const Hausdorff& h) {
        return py::str("<vmesh.Hausdorff: {:.6g} to {:.6g} mm>").format(h.lower(), h.upper());
      });
  py::class_<SampledDistance>(module, "SampledDistance", "Distances of points spread evenly over a surface.")
      .def_readonly("distance", &SampledDistance::distance, "mm; its maximum is a lower bound.")
      .def_readonly("samples_per_mm2", &SampledDistance::samples_per_mm2, "Points compared, per mm^2 of the surface.");
  py::class_<VesselDistanceSide>(module, "VesselDistanceSide", "Distances of points of one boundary from the other.")
      .def_readonly("mm", &VesselDistanceSide::mm, "In mm.")
      .def_readonly("relative", &VesselDistanceSide::relative, "In local radii.")
      .def_property_readonly(
          "max_at", [](const VesselDistanceSide& s) { return array_of(s.max_at); }, "(3,) mm.")
      .def_readonly("samples_per_mm2", &VesselDistanceSide::samples_per_mm2,
                    "Points compared, per mm^2 of the surface.");
  py::class_<VesselDistance>(module, "VesselDistance",
                             "The distance between a surface and the exact volume of a centerline, both ways.")
      .def_readonly("from_surface", &VesselDistance::from_mesh, "From the surface to the volume: VesselDistanceSide.")
      .def_readonly("from_volume", &VesselDistance::from_volume,
                    "From the volume's boundary to the surface: VesselDistanceSide.");
  py::class_<ReferenceDistance>(module, "ReferenceDistance", "The distance between two surfaces, both ways.")
      .def_readonly("hausdorff", &ReferenceDistance::hausdorff, "Hausdorff, forward from the surface to the reference.")
      .def_readonly("from_surface", &ReferenceDistance::from_surface, "To the reference: SampledDistance.")
      .def_readonly("from_reference", &ReferenceDistance::from_reference, "To the surface: SampledDistance.");
}

void bind_report(py::module_& module) {
  py::class_<Evaluation>(module, "Evaluation", "Measurements of a surface.")
      .def_readonly("vertices", &Evaluation::vertices, "Their number.")
      .def_readonly("faces", &Evaluation::faces, "Their number.")
      .def_readonly("area", &Evaluation::area, "mm^2.")
      .def_readonly("volume", &Evaluation::volume, "Enclosed, mm^3; None unless closed and oriented.")
      .def_property_readonly(
          "topology", [](const Evaluation& e) { return e.defects.topology; }, "Topology.")
      .def_readonly("skewness", &Evaluation::skewness, "Equiangle skewness of the faces: 0 equilateral, 1 degenerate.")
      .def_readonly("min_angle_deg", &Evaluation::min_angle, "Smallest angles of the faces.")
      .def_readonly("max_angle_deg", &Evaluation::max_angle, "Largest angles of the faces.")
      .def_property_readonly(
          "degenerate_faces",
          [](const Evaluation& e) { return array_of(std::vector<Index>(e.defects.degenerate_faces)); },
          "Faces without area, (n,) uint32.")
      .def_property_readonly(
          "duplicate_faces",
          [](const Evaluation& e) { return array_of(std::vector<Index>(e.defects.duplicate_faces)); },
          "Faces with the corners of an earlier one, (n,) uint32.")
      .def_property_readonly(
          "crossing_faces",
          [](const Evaluation& e) {
            std::vector<Index> pairs;
            for (const IntersectingFaces& pair : e.defects.self_intersections)
              pairs.insert(pairs.end(), {pair.first, pair.second});
            return array_of(std::move(pairs)).attr("reshape")(-1, 2);
          },
          "Pairs of faces that intersect, (n, 2) uint32.")
      .def_readonly("reference", &Evaluation::reference, "ReferenceDistance, or None without a reference.")
      .def_readonly("vessel", &Evaluation::vessel, "VesselDistance, or None without a centerline.");
}

py::tuple closest_points(const py::object& points, const SurfaceObject& surface) {
  const std::vector<Vec3> asked = to_points(points, "points");
  std::vector<double> found, distances;
  std::vector<Index> faces;
  {
    const py::gil_scoped_release release;
    const ClosestPointIndex index(surface.mesh());
    Index near = kNone;
    for (const Vec3& p : asked) {
      const ClosestPoint closest = index.closest(p, near);
      near = closest.face;
      found.insert(found.end(), closest.point.data(), closest.point.data() + 3);
      distances.push_back(closest.distance);
      faces.push_back(closest.face);
    }
  }
  return py::make_tuple(array_of(std::move(found)).attr("reshape")(-1, 3), array_of(std::move(faces)),
                        array_of(std::move(distances)));
}

}  // namespace

void bind_evaluation(py::module_& module) {
  bind_distribution(module);
  bind_topology(module);
  bind_distances(module);
  bind_report(module);
  module.def(
      "evaluate",
      [](const SurfacePtr& surface, const SurfacePtr& reference, const CenterlinePtr& centerline,
         const py::object& progress, std::size_t samples, double tolerance, int threads) {
        return result_of(progress, [&](const Progress& report) {
          return on_threads(threads, [&] {
            return evaluate(surface->mesh(), reference ? &reference->mesh() : nullptr,
                            centerline ? &centerline->centerline : nullptr, {samples, tolerance}, report);
          });
        });
      },
      py::arg("surface").none(false), py::arg("reference"), py::arg("centerline"), py::kw_only(), py::arg("progress"),
      py::arg("samples"), py::arg("tolerance"), py::arg("threads"), "vmesh.evaluate() without its checks.");
  module.def(
      "hausdorff",
      [](const SurfacePtr& a, const SurfacePtr& b, double tolerance, const py::object& progress) {
        return result_of(progress, [&](const Progress& report) {
          return hausdorff(a->mesh(), b->mesh(), {tolerance, report});
        });
      },
      py::arg("a").none(false), py::arg("b").none(false), py::kw_only(), py::arg("tolerance"), py::arg("progress"),
      "vmesh.hausdorff() without its checks.");
  module.def(
      "closest_points", &closest_points, py::arg("points"), py::arg("surface").none(false),
      "The points of a surface closest to `points`, (n, 3), mm: their positions (n, 3) float64, faces (n,) uint32\n"
      "and distances (n,) float64, mm.");
}

}  // namespace vmesh::python
