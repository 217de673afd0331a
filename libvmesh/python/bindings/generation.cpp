#include <variant>

#include "arrays.h"
#include "growth.h"
#include "module.h"
#include "running.h"

namespace vmesh::python {
namespace {

/// Throws TypeError, naming the option, if it is missing or of another type.
template <class T>
T option(const py::dict& options, const char* name) {
  if (!options.contains(name)) throw py::type_error(std::string("generate() needs the option ") + name);
  try {
    return options[name].cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(std::string(name) + ": not of the type that generate() takes");
  }
}

/// A length in radii, or "auto".
using Extension = std::variant<double, std::string>;

void take_extension(const Extension& given, double& extension, bool& fits) {
  const auto* text = std::get_if<std::string>(&given);
  if (text != nullptr && *text != "auto")
    throw InvalidInput("the extension \"" + *text + "\" is neither a number of radii nor \"auto\"");
  fits = text != nullptr;
  extension = fits ? kLongestFittedExtension : std::get<double>(given);
}

ProductionOptions request_of(const py::dict& given) {
  const auto text = [&](const char* name) { return option<std::string>(given, name); };
  ProductionOptions request;
  GenerateOptions& options = request.growth;
  options.around = option<int>(given, "around");
  if (const std::string max_error = text("max_error"); !max_error.empty())
    options.max_error = parse_error_limit(max_error);
  options.blend = option<double>(given, "blend");
  options.placement = parse_placement(text("placement"));
  options.growth = parse_growth_method(text("growth"));
  const std::string overlap = text("overlap");
  if (overlap != "separate" && overlap != "keep")
    throw InvalidInput("overlap: \"" + overlap + "\" is not known; there are separate and keep");
  request.preparation.separate = overlap == "separate";
  request.preparation.gap = option<double>(given, "gap");
  request.ends = parse_end_shape(text("ends"));
  options.open_ends.nodes = to_indices(option<py::object>(given, "open_ends"), "open_ends");
  take_extension(option<Extension>(given, "flow_extension"), request.extension, request.fit_extensions);
  options.simplification = option<double>(given, "simplification");
  options.elongation = option<double>(given, "elongation");
  options.ring_spacing = option<double>(given, "ring_spacing");
  options.least_vertices = option<std::size_t>(given, "least_vertices");
  options.deformable = option<bool>(given, "deformable");
  options.sweeps = option<int>(given, "sweeps");
  options.max_vertices = option<int>(given, "max_vertices");
  options.threads = option<int>(given, "threads");
  return request;
}

}  // namespace

void bind_generation(py::module_& module) {
  module.def(
      "generate",
      [](const CenterlinePtr& centerline, const py::object& progress, const py::kwargs& options) {
        const ProductionOptions request = request_of(options);
        std::optional<Budget> budget;
        if (const auto text = option<std::string>(options, "budget"); !text.empty()) budget = parse_budget(text);
        return result_of(progress, [&](const Progress& report) { return grow(centerline, request, budget, report); });
      },
      py::arg("centerline").none(false), py::kw_only(), py::arg("progress"), "vmesh.generate() without its checks.");
  module.def(
      "finish_ends",
      [](const SurfaceObject& surface, bool cap, const py::object& left_open, const Extension& extension,
         bool keep_area) {
        FlatEndOptions options;
        options.cap = cap;
        options.left_open = to_indices(left_open, "left_open");
        take_extension(extension, options.extension, options.fit_extensions);
        options.keep_area = keep_area;
        const py::gil_scoped_release release;
        return with_finished_ends(surface, options);
      },
      py::arg("surface"), py::kw_only(), py::arg("cap") = true, py::arg("left_open") = py::tuple(),
      py::arg("extension") = 0.0, py::arg("keep_area") = false,
      R"(A copy of a surface, its openings finished flat.

    cap        close the ends by flat caps
    left_open  nodes of the centerline whose ends stay open even so
    extension  length of straight extensions there, in radii; "auto": of each as long as there is room, at most 10
    keep_area  scale the rings to the area of the round cross-section; not for fitted surfaces

`Surface.flat_ends` lists them, `Surface.cap_label` says which faces are caps.)");
}

}  // namespace vmesh::python
