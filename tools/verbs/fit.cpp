#include <algorithm>
#include <sstream>

#include "vmesh/io/sha256.h"
#include "vmesh/surface/surface_attributes.h"

#include "command_line/arguments_growth.h"
#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/fit_report.h"
#include "report/pages.h"
#include "verbs/bound_surface.h"
#include "verbs/fitting.h"

namespace vmesh::tool::fit_verb {
namespace {

struct FitArguments {
  CommonArguments common;
  InputArguments input;       ///< surface
  InputArguments centerline;  ///< around which the surface was grown
  std::filesystem::path output;
  WritingArguments writing;
  FittingArguments fitting;
  std::optional<Budget> budget;  ///< sets the fit's max_vertices or its error
};

void add_options(CLI::App& verb, FitArguments& arguments) {
  add_input(verb, arguments.input, "surface, with places on the centerline (.ply, .vtp)");
  verb.add_option("REFERENCE", arguments.fitting.reference.path,
                  "surface, or image (" + listed_image_extensions() + ")")
      ->required();
  add_output(verb, arguments.output, kSurfaceFile, "surface");
  add_writing(verb, arguments.writing);
  verb.add_option("--centerline", arguments.centerline.path, "around which the surface was grown")->required();
  add_reading(verb, arguments.centerline, "centerline-");
  add_fitting(verb, arguments.fitting);
  verb.add_option("--max-vertices", arguments.fitting.options.max_vertices,
                  "0: a twentieth more than the surface has, or as many as --fit-error needs")
      ->capture_default_str();
  verb.add_option(kElongationFlag.data(), arguments.fitting.options.elongation,
                  "how much longer than wide triangles may be, where the reference is curved less along than across")
      ->check(in_range(1, kMostElongation))
      ->capture_default_str();
  add_budget(verb, arguments.budget, "vertices=N: as --max-vertices N; error=Xmm: as --fit-error Xmm")
      .type_name("vertices=N|error=Xmm")
      ->excludes("--max-vertices")
      ->excludes("--fit-error");
  add_threads(verb, arguments.fitting.options.threads);
  add_html(verb, arguments.common);
}

int run(const FitArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  FittingArguments fitting = arguments.fitting;
  if (arguments.budget) set_budget(*arguments.budget, fitting.options);
  check_writing(arguments.output, arguments.writing);
  check_outputs(
      {{arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}, {arguments.common.html, Kind::page}},
      files_of({&arguments.input, &arguments.centerline, &fitting.reference}));
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
  const bool near = keeps_error(result.report, wanted, warnings, console);
  const std::string sha256 = sha256_of_file(path);
  std::string options = "fit" + describe(fitting);
  if (wanted.max_vertices > 0) options += " --max-vertices " + std::to_string(wanted.max_vertices);
  const VesselSurface& fitted = result.surface;
  const SurfaceMeasurement measurement = measure_surface(fitted.mesh, result.elongation);
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
  write_json(arguments.common.json, json);
  if (!arguments.common.html.empty())
    write_page(arguments.common.html,
               page_of(arguments.common, result.report, json, fitted.mesh, attributes, reference, centerline), console);
  return near ? kOk : kNotConverged;
}

const VerbRegistration<FitArguments> kRegistration({
    .rank = 140,
    .name = "fit",
    .help = "Fit a surface grown by vmesh to a segmentation: a surface or an image",
    .examples = R"(Examples:
  vmesh fit tree.ply scan.stl --centerline tree.swc -o fitted.ply
  vmesh fit portal.ply liver.nii.gz --label 2 --spacing 1 --smooth 1 --centerline portal.swc -o fitted.ply \
    --html fitted.html)",
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::fit_verb
