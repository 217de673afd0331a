#include "arrays.h"
#include "growth.h"
#include "module.h"
#include "running.h"

namespace vmesh::python {
namespace {

ProductionOptions request_of(int around, const std::string& max_error, double blend, const std::string& placement,
                             const std::string& growth, const std::string& overlap, double gap, const std::string& ends,
                             const py::object& open_ends, double flow_extension, double simplification,
                             double elongation, std::size_t least_vertices, bool deformable, int sweeps,
                             int max_vertices, int threads) {
  ProductionOptions request;
  GenerateOptions& options = request.growth;
  options.around = around;
  if (!max_error.empty()) options.max_error = parse_error_limit(max_error);
  options.blend = blend;
  options.placement = parse_placement(placement);
  options.growth = parse_growth_method(growth);
  if (overlap != "separate" && overlap != "keep")
    throw InvalidInput("overlap: \"" + overlap + "\" is not known; there are separate and keep");
  request.preparation.separate = overlap == "separate";
  request.preparation.gap = gap;
  request.ends = parse_end_shape(ends);
  options.open_ends.nodes = to_indices(open_ends, "open_ends");
  request.extension = flow_extension;
  options.simplification = simplification;
  options.elongation = elongation;
  options.least_vertices = least_vertices;
  options.deformable = deformable;
  options.sweeps = sweeps;
  options.max_vertices = max_vertices;
  options.threads = threads;
  return request;
}

}  // namespace

void bind_generation(py::module_& module) {
  module.def(
      "generate",
      [](const CenterlinePtr& centerline, const py::object& progress, int around, const std::string& max_error,
         double blend, const std::string& placement, const std::string& growth, const std::string& overlap, double gap,
         const std::string& ends, const py::object& open_ends, double flow_extension, double simplification,
         double elongation, std::size_t least_vertices, bool deformable, int sweeps, int max_vertices, int threads) {
        const ProductionOptions request =
            request_of(around, max_error, blend, placement, growth, overlap, gap, ends, open_ends, flow_extension,
                       simplification, elongation, least_vertices, deformable, sweeps, max_vertices, threads);
        return result_of(progress, [&](const Progress& report) { return grow(centerline, request, report); });
      },
      py::arg("centerline").none(false), py::kw_only(), py::arg("progress"), py::arg("around"), py::arg("max_error"),
      py::arg("blend"), py::arg("placement"), py::arg("growth"), py::arg("overlap"), py::arg("gap"), py::arg("ends"),
      py::arg("open_ends"), py::arg("flow_extension"), py::arg("simplification"), py::arg("elongation"),
      py::arg("least_vertices"), py::arg("deformable"), py::arg("sweeps"), py::arg("max_vertices"), py::arg("threads"),
      "vmesh.generate() without its checks.");
  module.def(
      "finish_ends",
      [](const SurfaceObject& surface, bool cap, const py::object& left_open, double extension, bool keep_area) {
        FlatEndOptions options;
        options.cap = cap;
        options.left_open = to_indices(left_open, "left_open");
        options.extension = extension;
        options.keep_area = keep_area;
        const py::gil_scoped_release release;
        return with_finished_ends(surface, options);
      },
      py::arg("surface"), py::kw_only(), py::arg("cap") = true, py::arg("left_open") = py::tuple(),
      py::arg("extension") = 0.0, py::arg("keep_area") = false,
      R"(A copy of a surface, its openings finished flat.

    cap        close the ends by flat caps
    left_open  nodes of the centerline whose ends stay open even so
    extension  length of straight extensions there, in radii
    keep_area  scale the rings to the area of the round cross-section; not for fitted surfaces

`Surface.flat_ends` lists them, `Surface.cap_label` says which faces are caps.)");
}

}  // namespace vmesh::python
