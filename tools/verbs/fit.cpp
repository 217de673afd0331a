#include <algorithm>
#include <sstream>

#include "vmesh/io/sha256.h"
#include "vmesh/surface/surface_attributes.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "report/fit_report.h"
#include "report/pages.h"
#include "verbs/fitting.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

const std::vector<double>* find(const std::vector<MeshAttribute>& attributes, const std::string& name) {
  const auto found = std::find_if(attributes.begin(), attributes.end(), [&](const auto& a) { return a.name == name; });
  return found == attributes.end() ? nullptr : &found->values;
}

std::vector<CenterlineBinding> binding_of(const LoadedSurface& surface, const Centerline& centerline) {
  const std::vector<double>* segment = find(surface.attributes.vertex, "segment");
  const std::vector<double>* t = find(surface.attributes.vertex, "parameter");
  if (!segment || !t)
    throw InvalidInput(
        "the surface has no places on a centerline (vertex attributes segment and parameter); take one "
        "that vmesh generate wrote as .ply or .vtp");
  std::vector<CenterlineBinding> binding;
  for (std::size_t v = 0; v < surface.mesh.vertices.size(); ++v) {
    const double s = (*segment)[v];
    if (!(s >= 0 && s < static_cast<double>(centerline.segments().size() + centerline.nodes().size())))
      throw InvalidInput("vertex " + std::to_string(v) +
                         " is bound to a segment that the centerline does not have; is "
                         "it the one around which the surface was grown?");
    binding.push_back({static_cast<Index>(s), std::clamp((*t)[v], 0.0, 1.0)});
  }
  return binding;
}

}  // namespace

int run(const FitArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  FittingArguments fitting = arguments.fitting;
  if (arguments.budget) set_budget(*arguments.budget, fitting.options);
  std::vector<std::filesystem::path> inputs = files_of(arguments.centerline.path);
  inputs.push_back(path);
  for (const std::filesystem::path& file : files_of_input(fitting.reference.path)) inputs.push_back(file);
  check_writing(arguments.output, arguments.writing);
  check_outputs(
      {{arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}, {arguments.common.html, Kind::page}},
      inputs);
  LoadedSurface loaded = load_surface(arguments.input);
  console.warn(loaded.warnings);
  const Centerline centerline = load_clean_centerline(arguments.centerline, console).cleaned.centerline;
  const VesselSurface surface = naming(path, [&] {
    return VesselSurface{loaded.mesh, binding_of(loaded, centerline), {}};
  });
  const TriMesh reference = load_fit_reference(fitting, console);
  stop_if_interrupted();
  const FitOptions& wanted = fitting.options;
  const FitResult result =
      naming(path, [&] { return fit_surface(surface, centerline, reference, wanted, console.progress()); });
  std::vector<std::string> warnings;
  log_fit(result.report, warnings, console);
  const bool near = keeps_error(result.report, wanted.error, warnings, console);
  const std::string sha256 = sha256_of_file(path);
  std::string options = "fit" + describe(fitting);
  if (wanted.max_vertices > 0) options += " --max-vertices " + std::to_string(wanted.max_vertices);
  const VesselSurface& fitted = result.surface;
  const SurfaceMeasurement measurement = measure_surface(fitted.mesh);
  if (measurement.self_intersections > 0) {
    console.error(path.string() + ": fitted, " + std::to_string(measurement.self_intersections) +
                  " pairs of its faces cross; nothing is written");
    return kDefective;
  }
  const MeshAttributes attributes =
      surface_attributes(fitted.mesh, fitted.binding, result.radius, fitted.openings, centerline);
  write_surface(arguments.output, fitted.mesh, attributes,
                {generator_name(), options, path.filename().string(), sha256}, arguments.writing);
  console.log(std::to_string(result.surface.mesh.vertices.size()) + " vertices, skewness " +
              std::to_string(measurement.skewness.mean) + " mean, " + std::to_string(measurement.skewness.max) +
              " max");
  console.log("wrote " + arguments.output.string());
  if (arguments.common.json.empty() && arguments.common.html.empty()) return near ? kOk : kNotConverged;
  Json json = {{"schema", "vmesh.fit/1"},
               {"generator", generator_json()},
               {"input", {{"file", path.string()}, {"sha256", sha256}}},
               {"reference", fitting.reference.path.string()},
               {"output", arguments.output.string()},
               {"options", options},
               {"vertices", result.surface.mesh.vertices.size()},
               {"faces", result.surface.mesh.faces.size()},
               {"fit", to_json(result.report)},
               {"warnings", warnings}};
  json.update(to_json(measurement));
  if (!arguments.common.json.empty()) write_json(arguments.common.json, json);
  if (!arguments.common.html.empty())
    write_page(arguments.common.html,
               page_of(arguments, result.report, json, fitted.mesh, attributes, reference, centerline), console);
  return near ? kOk : kNotConverged;
}

}  // namespace vmesh::tool
