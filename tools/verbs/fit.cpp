#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "vmesh/core/text.h"
#include "vmesh/fit/fit_capped_surface.h"
#include "vmesh/io/sha256.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/patch_names.h"
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

/// The patches that a surface's file tells of, from 1, and which of them are caps: all that are no walls.
std::optional<CappedPatches> patches_of(const MeshAttributes& attributes) {
  const MeshAttribute* numbers = find_attribute(attributes.face, "ModelFaceID");
  if (numbers == nullptr) return std::nullopt;
  CappedPatches patches;
  std::set<Index> caps;
  for (std::size_t f = 0; f < numbers->values.size(); ++f) {
    constexpr double kMost = 1e9;
    const double number = numbers->values[f];
    if (!(number >= 1 && number <= kMost && number == std::floor(number)))
      throw InvalidInput(
          formatted("face %zu: ModelFaceID %g; 1 is the wall, and caps are numbered from 2 on", f, number));
    const auto patch = static_cast<Index>(number);
    patches.patch.push_back(patch);
    if (!is_wall_patch(patch, attributes.patch_names)) caps.insert(patch);
  }
  patches.caps.assign(caps.begin(), caps.end());
  return patches;
}

/// The fitted surface, and the patches of its faces if it had some.
struct FittedSurface {
  FitResult fit;
  std::vector<Index> patch;
};

FittedSurface fit_with_patches(const VesselSurface& surface, const std::optional<CappedPatches>& patches,
                               const Centerline& centerline, const TriMesh& reference, const FitOptions& options,
                               const Progress& progress) {
  if (patches && !patches->caps.empty()) {
    CappedFit capped = fit_capped_surface(surface, *patches, centerline, reference, options, progress);
    return {std::move(capped.fit), std::move(capped.patch)};
  }
  FittedSurface fitted{fit_surface(surface, centerline, reference, options, progress), {}};
  if (patches) fitted.patch = patches_by_branch(surface, patches->patch, fitted.fit.surface, centerline);
  return fitted;
}

/// Adds the numbers of patches, as the surface's file had them, and their names.
void add_patches(const std::vector<Index>& patch, const MeshAttributes& before, MeshAttributes& attributes) {
  if (patch.empty()) return;
  attributes.face.push_back({"ModelFaceID", {patch.begin(), patch.end()}, true});
  attributes.patch_names = before.patch_names;
  const MeshAttribute* numbers = find_attribute(before.face, "ModelFaceID");
  const MeshAttribute* caps = find_attribute(before.face, "CapID");
  if (caps == nullptr) return;
  std::map<Index, double> cap_of_patch;
  for (std::size_t f = 0; f < caps->values.size(); ++f)
    cap_of_patch[static_cast<Index>(numbers->values[f])] = caps->values[f];
  MeshAttribute cap{"CapID", {}, true};
  for (const Index p : patch) cap.values.push_back(cap_of_patch.at(p));
  attributes.face.push_back(std::move(cap));
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
  const FittedSurface with_patches = naming(path, [&] {
    return fit_with_patches(surface, patches_of(loaded.attributes), centerline, reference, wanted, console.progress());
  });
  const FitResult& result = with_patches.fit;
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
  MeshAttributes attributes =
      surface_attributes(fitted.mesh, fitted.binding, result.radius, fitted.openings, centerline);
  add_patches(with_patches.patch, loaded.attributes, attributes);
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
