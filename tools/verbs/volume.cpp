#include "vmesh/core/text.h"
#include "vmesh/deform/volume_places.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/io/volume_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/mesh/volume_faces.h"
#include "vmesh/solid/branch_regions.h"
#include "vmesh/solid/make_volume.h"

#include "command_line/arguments_growth.h"
#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/generate_log.h"
#include "report/volume_report.h"
#include "verbs/end_names.h"
#include "verbs/extraction.h"
#include "verbs/grown_surface.h"

namespace vmesh::tool::volume_verb {
namespace {

struct VolumeArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  WritingArguments writing;
  VolumeWriteOptions format;
  GenerateArguments growth;  ///< how it is made where the input is none; its input and output do not count
  VolumeOptions volume;
  bool has_shell_thickness = false;
  bool by_branch = false;     ///< divide regions
  InputArguments centerline;  ///< for that, where the input is a surface
};

/// "0.3mm" is in mm, "0.2" in local radii. Throws InvalidInput.
void take_thickness(const std::string& text, LayerOptions& layers) {
  layers.in_mm = text.ends_with("mm");
  const std::string number = layers.in_mm ? text.substr(0, text.size() - 2) : text;
  if (!CLI::detail::lexical_cast(number, layers.thickness) || !(layers.thickness > 0 && layers.thickness < 1e9))
    throw InvalidInput("\"" + text +
                       "\" is neither a share of the local radius such as 0.2 nor a length such as 0.3mm");
}

void take_first_layer(const std::string& text, LayerOptions& layers) {
  if (!text.ends_with("mm") || !CLI::detail::lexical_cast(text.substr(0, text.size() - 2), layers.first_mm) ||
      !(layers.first_mm > 0 && layers.first_mm < 1e9))
    throw InvalidInput("\"" + text + "\" is not a length such as 0.05mm");
}

void add_layers(CLI::App& verb, VolumeArguments& arguments) {
  VolumeOptions& options = arguments.volume;
  add_number(verb, "--layers", options.layers.count, 0, kMostLayers, "layers of wedges along the wall; 0: none");
  add_read_option(
      verb, "--layer-thickness", [&options](const std::string& text) { take_thickness(text, options.layers); },
      "of all layers together: a share of the local radius, or a length in mm")
      .type_name("SHARE|Xmm")
      ->default_str("0.2");
  add_read_option(
      verb, "--first-layer", [&options](const std::string& text) { take_first_layer(text, options.layers); },
      "thickness of the layer at the wall, from which that of all follows")
      .type_name("Xmm")
      ->excludes("--layer-thickness");
  add_number(verb, "--layer-growth", options.layers.growth, 0.5, 5.0,
             "thickness of a layer by that of the one nearer to the wall");
  add_number(verb, "--core-size", options.core_size, 0.0, 1000.0,
             "length of edges of tetrahedra within, in local radii; 0: as those of the surface");
}

void add_shell(CLI::App& verb, VolumeArguments& arguments) {
  VolumeOptions& options = arguments.volume;
  add_read_option(
      verb, "--wall-thickness",
      [&arguments](const std::string& text) {
        take_thickness(text, arguments.volume.shell);
        arguments.has_shell_thickness = true;
      },
      "mesh the vessel's own wall too, outwards from the surface: a share of the local radius, or a length in mm")
      .type_name("SHARE|Xmm");
  add_number(verb, "--wall-layers", options.shell.count, 0, kMostLayers,
             "layers of wedges across it; 0: 2 with --wall-thickness");
  verb.add_flag("--merge-walls", options.shell.merged,
                "where the walls of two vessels meet, make them one, with tetrahedra between their layers; else both "
                "are thinner there");
  verb.add_flag("--wall-only", options.shell_only, "mesh the wall only, not what is within");
}

void add_options(CLI::App& verb, VolumeArguments& arguments) {
  add_centerline_input(verb, arguments.input,
                       "surface with radii of vmesh generate (.vtp or .ply); or what that makes one of: a centerline, "
                       "an image, a wall");
  add_output_after_several(verb, arguments.output, kVolumeFile,
                           "volume mesh (" + written_volume_files() +
                               "), or its outside as a closed surface, to print for example (.stl, .3mf)");
  add_output_frame(verb, arguments.writing);
  verb.add_flag("--tetrahedra", arguments.format.split_cells,
                "split wedges and pyramids into tetrahedra, for files and solvers that have none");
  add_layers(verb, arguments);
  add_shell(verb, arguments);
  add_regions(
      verb, [&arguments] { arguments.by_branch = true; },
      "divide regions by the branch of the vessel nearest to a cell: lumen_0, lumen_1 ...");
  verb.add_option("--centerline", arguments.centerline.path,
                  "with --regions, if the input is a surface: around which it was grown")
      ->type_name(kFile);
  add_reading(verb, arguments.centerline, "centerline-");
  GenerateArguments& surface = arguments.growth;
  surface.production.ends = EndShape::flat;
  add_growth(verb, surface.production);
  add_ends(verb, surface.production);
  add_end_names(verb, surface.end_names);
  verb.add_option("--fit", surface.fitting.reference.path,
                  "fit the surface to this surface or image, as generate does");
  add_fitting(verb, surface.fitting);
  add_extraction(verb, surface.extraction);
  group(verb, "Layers", {"--layers", "--layer-thickness", "--first-layer", "--layer-growth", "--core-size"});
  group(verb, "Regions", {"--regions", "--centerline", "--centerline-unit", "--centerline-space"});
  group(verb, "The vessel's wall", {"--wall-thickness", "--wall-layers", "--merge-walls", "--wall-only"});
  const char* grown = "The surface, where the input is none";
  group(verb, grown,
        {"--around", "--preset", "--max-vertices", "--simplification", "--elongation", "--blend", "--placement",
         "--overlap", "--gap", "--ends", "--open-ends", "--flow-extensions", "--name", "--names", "--beta",
         "--max-center-distance", "--sweeps", "--threads"});
}

void settle(VolumeArguments& arguments) {
  settle_output(arguments);
  settle_ends(arguments.growth.production);
  expand_folders(arguments.growth.fitting.reference);
  LayerOptions& shell = arguments.volume.shell;
  if (arguments.has_shell_thickness && shell.count == 0) shell.count = 2;
  if (shell.count > 0 && !arguments.has_shell_thickness)
    throw UsageError("--wall-layers needs --wall-thickness: a share of the local radius such as 0.2, or 0.8mm");
  if (arguments.volume.shell_only && shell.count == 0)
    throw UsageError("--wall-only needs --wall-thickness: a share of the local radius such as 0.2, or 0.8mm");
  if (arguments.volume.shell.merged && shell.count == 0)
    throw UsageError("--merge-walls needs --wall-thickness: a share of the local radius such as 0.2, or 0.8mm");
  if (!arguments.centerline.path.empty() && !arguments.by_branch)
    throw UsageError("--centerline is for --regions branches");
  const ProductionOptions& production = arguments.growth.production;
  if (production.ends == EndShape::open || !production.growth.open_ends.nodes.empty())
    throw UsageError("the surface of a volume must be closed: --ends flat, or round");
}

std::string thickness_text(const LayerOptions& layers) {
  return formatted("%g", layers.thickness) + (layers.in_mm ? "mm" : "");
}

/// "volume --layers 4 ...": how a mesh was made.
std::string describe_volume(const VolumeOptions& options) {
  std::string text = "volume";
  if (!options.shell_only) {
    text += " --layers " + std::to_string(options.layers.count);
    if (options.layers.first_mm > 0) {
      text += formatted(" --first-layer %gmm", options.layers.first_mm);
    } else {
      text += " --layer-thickness " + thickness_text(options.layers);
    }
    text += formatted(" --layer-growth %g --core-size %g", options.layers.growth, options.core_size);
  }
  if (options.shell.count > 0)
    text +=
        " --wall-thickness " + thickness_text(options.shell) + " --wall-layers " + std::to_string(options.shell.count);
  if (options.shell.merged) text += " --merge-walls";
  return options.shell_only ? text + " --wall-only" : text;
}

/// What a volume is made of, and how that was made.
struct VolumeSource {
  VesselWall wall;
  std::string how;  ///< empty for a surface as it was given
  std::vector<StageTime> stages;
  std::optional<Centerline> centerline;  ///< if regions are divided
};

/// The surface in a file, if it is one with radii.
std::optional<VolumeSource> read_source(const VolumeArguments& arguments, Console& console) {
  if (!find_surface_format(arguments.input.path) || !is_segmentation(arguments.input)) return std::nullopt;
  StageClock clock;
  LoadedSurface surface = load_surface(arguments.input);
  if (!find_attribute(surface.attributes.vertex, "radius")) return std::nullopt;
  console.warn(surface.warnings);
  VolumeSource source;
  if (arguments.by_branch && arguments.centerline.path.empty())
    throw UsageError(
        "--regions branches of a surface needs the centerline around which it was grown: --centerline FILE");
  if (arguments.by_branch) source.centerline = load_clean_centerline(arguments.centerline, console).cleaned.centerline;
  source.wall = naming(arguments.input.path, [&] { return vessel_wall(std::move(surface.mesh), surface.attributes); });
  clock.lap("read", source.stages);
  return source;
}

/// Of a surface that is grown; empty if it is not sound, after saying why.
std::optional<VolumeSource> grow_source(const VolumeArguments& arguments, Console& console) {
  if (!arguments.centerline.path.empty())
    throw UsageError("--centerline is for surfaces of vmesh generate; here, the surface is made around one");
  GenerateArguments surface = arguments.growth;
  surface.input = arguments.input;
  surface.segmentation = is_segmentation(surface.input);
  check_input(surface);
  check_growth(surface);
  const auto grown = grow_surface(surface, console);
  if (!grown->result().is_sound()) {
    log_refusal(grown->report, console);
    return std::nullopt;
  }
  return VolumeSource{vessel_wall(grown->result().mesh, grown->attributes()), describe(grown->arguments),
                      grown->report.stages, grown->report.cleaned->centerline};
}

void divide_by_branch(VolumeMesh& mesh, const Centerline& centerline, bool is_of_a_file) {
  constexpr double kFarthest = 4;  // local radii: then, it is another centerline's mesh
  if (is_of_a_file) volume_places(centerline, mesh, {}, {}, kFarthest);  // throws
  divide_regions(mesh, branches_of_cells(mesh, centerline));
}

/// Whether the outside of the volume is to be written, as a surface.
bool writes_outside(const VolumeArguments& arguments) {
  const SurfaceFormat* format = find_surface_format(arguments.output);
  return find_volume_format(arguments.output) == nullptr && format != nullptr && format->write != nullptr;
}

void write_outside(const VolumeArguments& arguments, const VolumeMesh& mesh, const VolumeReport& report) {
  const BoundarySurface outside = boundary_surface(mesh);
  MeshAttribute face{"ModelFaceID", {}, true};
  for (const Index patch : outside.patch) face.values.push_back(1.0 + patch);
  MeshAttributes attributes;
  attributes.face.push_back(std::move(face));
  attributes.patch_names = mesh.patch_names;
  write_surface(arguments.output, outside.mesh, std::move(attributes),
                {generator_name(), report.options, file_name_of(arguments.input), report.input_sha256},
                arguments.writing);
}

int run(const VolumeArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check_outputs({{arguments.output, writes_outside(arguments) ? Kind::surface : Kind::volume},
                 {arguments.common.json, Kind::summary}},
                files_of({&arguments.input, &arguments.centerline, &arguments.growth.fitting.reference}));
  if ((!arguments.volume.shell_only || arguments.volume.shell.merged) && !can_mesh_lumen())
    throw Unsupported(
        "this vmesh was built without TetGen, which fills lumens with tetrahedra; build it after "
        "scripts/install-dependencies, with -DVMESH_WITH_TETGEN=ON, or give --wall-only without --merge-walls");
  Stopwatch watch;
  std::optional<VolumeSource> source = read_source(arguments, console);
  if (!source) source = grow_source(arguments, console);
  if (!source) return kDefective;
  stop_if_interrupted();

  VolumeResult result = naming(path, [&] { return make_volume(source->wall, arguments.volume, console.progress()); });
  if (!result.is_sound()) {
    std::vector<std::string> defects;
    for (const VolumeDefect& defect : result.defects)
      defects.push_back(std::string(to_string(defect.kind)) + ": " + defect.message);
    log_refusal(defects,
                path.string() +
                    ": no sound volume mesh was found, nothing is written: try fewer or thinner layers, or "
                    "another --around",
                console);
    return kDefective;
  }

  if (arguments.by_branch)
    naming(path, [&] { divide_by_branch(result.mesh, *source->centerline, source->how.empty()); });
  VolumeReport report = {
      path,    sha256_of(arguments.input),  describe_volume(arguments.volume), &arguments.volume, &source->wall,
      &result, measure_volume(result.mesh), std::move(source->stages)};
  if (arguments.by_branch) report.options += " --regions branches";
  if (!source->how.empty()) report.options += " of " + source->how;
  report.stages.insert(report.stages.end(), result.stages.begin(), result.stages.end());
  StageClock clock;
  if (writes_outside(arguments)) {
    write_outside(arguments, result.mesh, report);
  } else {
    write_volume(arguments.output, result.mesh,
                 {generator_name(), report.options, file_name_of(arguments.input), report.input_sha256,
                  arguments.writing.unit, arguments.writing.space},
                 {}, arguments.format);
  }
  clock.lap("write", report.stages);
  log_volume(report, console);
  console.log("wrote " + arguments.output.string() + formatted(" after %.2f s", watch.lap()));
  if (!arguments.common.json.empty()) write_json(arguments.common.json, to_json(report));
  return kOk;
}

const VerbRegistration<VolumeArguments> kRegistration({
    .rank = 15,
    .name = "volume",
    .help = "Mesh the lumen within a surface, and the vessel's wall, for solvers (tetrahedra by TetGen, whose license "
            "is AGPL-3)",
    .examples = R"(Examples:
  vmesh volume tree.swc -o tree.vtu
  vmesh generate aorta.vtp -o aorta-flow.vtp --ends flat --flow-extensions auto
  vmesh volume aorta-flow.vtp -o aorta.vtu --layers 6 --first-layer 0.05mm --layer-growth 1.3 --json aorta.json
  vmesh volume tree.swc -o coupled.vtu --wall-thickness 0.8mm --wall-layers 3
  vmesh volume aorta-flow.vtp -o branches.vtu --regions branches --centerline aorta.vtp
  vmesh volume aorta-flow.vtp -o wall.vtu --wall-thickness 0.15 --wall-only
  vmesh volume aorta.vtp -o print.3mf --wall-thickness 1.2mm --wall-only --merge-walls
Where layers do not fit, they are thinner, or end; the messages and the summary name the places.)",
    .add_options = add_options,
    .settle = settle,
    .threads = [](const VolumeArguments& arguments) { return arguments.growth.production.growth.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::volume_verb
