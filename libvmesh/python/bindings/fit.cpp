#include <algorithm>

#include "vmesh/fit/fit_surface.h"
#include "vmesh/mesh/topology.h"
#include "vmesh/surface/flat_reference.h"

#include "arrays.h"
#include "module.h"
#include "objects.h"
#include "running.h"
#include "text.h"

namespace vmesh::python {
namespace {

bool was_grown(const SurfaceObject& surface) { return surface.result.check.topology.components > 0; }

/// Fits a surface grown here: moves openings to flat ends of the reference, and looks for defects.
void fit_grown(SurfaceObject& surface, const TriMesh& reference, const FitOptions& options, const Progress& progress) {
  const Centerline& centerline = surface.centerline->centerline;
  const FlatReference flat = end_at_caps(surface.result, reference);
  surface.fit = fit_surface(surface.result, centerline, flat.mesh, options, progress);
  match_cap_areas(surface.result, centerline, flat.caps);
  if (options.max_error > 0 && !flat.caps.empty())
    find_far_parts(*surface.fit, {surface.result.mesh, surface.result.binding, surface.result.openings}, centerline,
                   flat.mesh, options.max_error);
}

void fit_bound(SurfaceObject& surface, const TriMesh& reference, const FitOptions& options, const Progress& progress) {
  GenerateResult& result = surface.result;
  FitResult fitted = fit_surface(VesselSurface{result.mesh, result.binding, {}}, surface.centerline->centerline,
                                 reference, options, progress);
  result.mesh = std::move(fitted.surface.mesh);
  result.binding = std::move(fitted.surface.binding);
  result.openings = std::move(fitted.surface.openings);
  result.radius = std::move(fitted.radius);
  result.elongation = std::move(fitted.elongation);
  surface.fit = std::move(fitted.report);
  if (const auto pairs = self_intersections(result.mesh); !pairs.empty()) {
    Defect defect;
    defect.position = result.mesh.vertices[result.mesh.faces[pairs.front().first][0]];
    defect.count = pairs.size();
    defect.message = counted(pairs.size(), "pair") + " of faces cross";
    result.defects = {defect};
  }
}

SurfacePtr fit(const SurfaceObject& surface, const SurfaceObject& reference, const FitOptions& options,
               const Progress& progress) {
  if (!surface.centerline)
    throw InvalidInput(
        "the surface is not bound to a centerline: read or make it with the one around which it was grown");
  const std::vector<FlatEnd>& ends = surface.ends.ends;
  if (std::any_of(ends.begin(), ends.end(), [](const FlatEnd& end) { return end.capped; }))
    throw InvalidInput("the surface's ends are already capped: fit it with ends=\"open\", then use finish_ends()");
  auto result = std::make_shared<SurfaceObject>(surface);
  result->ends = {};
  was_grown(surface) ? fit_grown(*result, reference.mesh(), options, progress)
                     : fit_bound(*result, reference.mesh(), options, progress);
  return result;
}

void bind_reports(py::module_& module) {
  py::class_<FitDistance>(module, "FitDistance", "The distance between a surface and its reference, both ways, mm.")
      .def_readonly("hausdorff", &FitDistance::hausdorff, "Forward: from the surface to the reference.")
      .def_readonly("from_surface", &FitDistance::from_surface, "To the reference: SampledDistance.")
      .def_readonly("from_reference", &FitDistance::from_reference, "To the surface: SampledDistance.")
      .def_property_readonly("mean", &FitDistance::mean, "Of the worse direction.")
      .def_property_readonly("rms", &FitDistance::rms, "Of the worse direction.")
      .def_property_readonly("p95", &FitDistance::p95, "95 % are nearer, in the worse direction.");
  py::class_<UnmatchedPart>(module, "UnmatchedPart", "A region of one surface without a counterpart on the other.")
      .def_property_readonly(
          "position", [](const UnmatchedPart& p) { return array_of(p.position); },
          "(3,) mm: its point farthest from the other surface.")
      .def_readonly("distance", &UnmatchedPart::distance, "Of that point, mm.")
      .def_readonly("area", &UnmatchedPart::area, "mm^2.")
      .def_readonly("inside", &UnmatchedPart::inside, "That point lies inside the other surface.")
      .def_property_readonly(
          "segment", [](const UnmatchedPart& p) { return optional_index(p.segment); },
          "The nearest of the centerline, or None.");
  py::class_<FitReport>(module, "FitReport", "What fitting did.")
      .def_readonly("vertices_before", &FitReport::vertices_before, "Number of vertices before.")
      .def_readonly("before", &FitReport::before, "The distance before.")
      .def_readonly("after", &FitReport::after, "The distance after.")
      .def_readonly("parts_apart", &FitReport::parts_apart,
                    "Components of the reference that mostly belong to no vessel; they were left out.")
      .def_readonly("area_apart", &FitReport::area_apart, "Their area, mm^2.")
      .def_readonly("uncovered", &FitReport::uncovered,
                    "Regions of the reference that no vessel covers. Largest first.")
      .def_readonly("unsupported", &FitReport::unsupported, "Regions of the surface that the reference lacks.")
      .def_readonly("beyond", &FitReport::beyond,
                    "With max_error, regions that are farther than it; the list is empty where that is proven.")
      .def_readonly("nodes_outside", &FitReport::nodes_outside, "Nodes of the centerline outside the fitted surface.")
      .def_readonly("turned", &FitReport::turned, "The reference faced inwards and was turned over.")
      .def_readonly("rounds", &FitReport::rounds, "Rounds that were made.");
}

}  // namespace

void bind_fit(py::module_& module) {
  bind_reports(module);
  module.def(
      "fit",
      [](const SurfacePtr& surface, const SurfacePtr& reference, const py::object& progress, int rounds, bool resize,
         std::size_t max_vertices, double error, double max_error, double elongation, bool deformable,
         double max_skewness, std::size_t samples, double tolerance, int threads) {
        const FitOptions options{rounds,     resize,       max_vertices, error,     max_error, elongation,
                                 deformable, max_skewness, samples,      tolerance, threads};
        return result_of(progress, [&](const Progress& report) { return fit(*surface, *reference, options, report); });
      },
      py::arg("surface").none(false), py::arg("reference").none(false), py::kw_only(), py::arg("progress"),
      py::arg("rounds"), py::arg("resize"), py::arg("max_vertices"), py::arg("error"), py::arg("max_error"),
      py::arg("elongation"), py::arg("deformable"), py::arg("max_skewness"), py::arg("samples"), py::arg("tolerance"),
      py::arg("threads"), "vmesh.fit() without its checks.");
}

}  // namespace vmesh::python
