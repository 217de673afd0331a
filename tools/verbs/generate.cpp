#include <charconv>
#include <sstream>
#include <utility>

#include "vmesh/core/text.h"
#include "vmesh/deform/linear_skin.h"
#include "vmesh/parts/part_files.h"
#include "vmesh/surface/flat_reference.h"
#include "vmesh/surface/surface_attributes.h"
#include "vmesh/volume/vessel_field.h"

#include "command_line/arguments_growth.h"
#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/fit_report.h"
#include "report/generate_log.h"
#include "report/pages.h"
#include "verbs/extraction.h"
#include "verbs/generate_input.h"
#include "verbs/part.h"

namespace vmesh::tool::generate_verb {
namespace {

OpenEnds parse_open_ends(const std::string& text) {
  OpenEnds ends;
  ends.all = text == "all";
  if (ends.all) return ends;
  std::istringstream list(text);
  for (std::string item; std::getline(list, item, ',');) {
    Index node = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), node);
    if (error != std::errc() || end != item.data() + item.size())
      throw CLI::ValidationError("--open-ends",
                                 "\"" + item + "\" is not a node number; give all, or numbers such as 3,17");
    ends.nodes.push_back(node);
  }
  return ends;
}

void take_extensions(const std::string& text, ProductionOptions& options) {
  constexpr double kLongest = 1000;
  options.fit_extensions = text == "auto";
  options.extension = kLongestFittedExtension;
  if (options.fit_extensions) return;
  if (!CLI::detail::lexical_cast(text, options.extension) || !(options.extension >= 0 && options.extension <= kLongest))
    throw InvalidInput("\"" + text + "\" is neither auto nor a number of radii from 0 to " + formatted("%g", kLongest));
}

void add_ends(CLI::App& verb, ProductionOptions& options) {
  add_choice(
      verb, "--ends", {"round", "flat", "open"},
      [&options](const std::string& text) { options.ends = parse_end_shape(text); },
      "how vessels end: round; flat: closed by flat caps, numbered for flow solvers (ModelFaceID, CapID in .vtp "
      "and .ply); open: not closed")
      ->default_str("round");
  verb.add_option_function<std::string>(
          "--open-ends", [&options](const std::string& text) { options.growth.open_ends = parse_open_ends(text); },
          "leave the surface open at these ends of the centerline, regardless of --ends: all, or node numbers as in "
          "the summary, separated by commas")
      ->type_name("all|N,N,...");
  add_read_option(
      verb, "--flow-extensions", [&options](const std::string& text) { take_extensions(text, options); },
      "length of straight extensions at ends that are not round, in radii; auto: at each end as long as there is room, "
      "at most " +
          formatted("%g", kLongestFittedExtension) + " radii; 0: none")
      .type_name("R|auto")
      ->default_str("0");
}

/// With --ends, --open-ends all means that all are open.
void settle_ends(ProductionOptions& options) {
  OpenEnds& open = options.growth.open_ends;
  if (options.extension > 0 && options.ends == EndShape::round && !open.all && open.nodes.empty())
    throw UsageError("--flow-extensions needs ends that are not round: --ends flat, or --ends open");
  if (options.ends == EndShape::round || !open.all) return;
  options.ends = EndShape::open;
  open = {};
}

void add_options(CLI::App& verb, GenerateArguments& arguments) {
  add_centerline_input(verb, arguments.input,
                       "centerline, or segmentation to extract it from and to fit to: an image (" +
                           listed_image_extensions() + ") or a wall (.stl, .ply, .obj, .vtp ...), open or closed");
  const auto written = extensions_of(surface_formats(), [](const auto& f) { return f.is_written(); });
  add_output_after_several(verb, arguments.output, kSurfaceFile, "surface (" + listed(written) + ")");
  add_writing(verb, arguments.writing);
  verb.add_flag("--bones", arguments.bones, "add bones along the centerline to a .glb, for bending it");
  add_growth(verb, arguments.production);
  add_choice(
      verb, "--growth", {"guided", "paper"},
      [&arguments](const std::string& text) { arguments.production.growth.growth = parse_growth_method(text); },
      "guided: with the topology of the centerline; paper: a single seed, as published")
      ->default_str("guided");
  add_read_option(
      verb, "--max-error",
      [&arguments](const std::string& text) { arguments.production.growth.max_error = parse_error_limit(text); },
      "refine until the surface is proven to be no farther than this from the boundary, and the boundary from it: "
      "0.3mm, 10% (of the local radius), or both, separated by a comma")
      .type_name("Xmm|X%");
  verb.add_option("--ring-spacing", arguments.production.growth.ring_spacing,
                  "distance of rings along vessels by that of even triangles, for numbers of vertices between "
                  "those of --around")
      ->check(in_range(kLeastRingSpacing, kMostRingSpacing));
  verb.add_option("--least-vertices", arguments.production.growth.least_vertices,
                  "with --elongation: leave out vertices until this number is left, where they "
                  "reduce the mean error most; with --max-error, only as long as that stays proven; 0: as few as "
                  "--max-error allows")
      ->capture_default_str();
  verb.add_flag("--deformable", arguments.production.growth.deformable,
                "for a centerline that is to move: a ring of vertices at every node, whatever the elongation");
  add_budget(verb, arguments.budget,
             "choose the resolution: the finest surface with vertices=N at most, or grown within time=Xms, or the one "
             "with the fewest vertices that keeps error=Xmm or error=X% everywhere; with --elongation, vertices=N are "
             "where they reduce the mean error most")
      .type_name("vertices=N|time=Xms|error=X")
      ->excludes("--around")
      ->excludes("--preset")
      ->excludes("--max-error")
      ->excludes("--least-vertices")
      ->excludes("--ring-spacing");
  add_ends(verb, arguments.production);
  verb.add_flag("--check", arguments.check,
                "exit with 1 unless the surface is closed, manifold, free of "
                "self-intersections, of the expected topology, and contains every centerline node");
  verb.add_flag("--allow-defects", arguments.allow_defects,
                "write the surface even if it is not sound; the summary lists its defects with their positions");
  verb.add_option("--fit", arguments.fitting.reference.path,
                  "fit to this surface or image: the vessels' own walls instead of round cones");
  add_fitting(verb, arguments.fitting);
  verb.add_option("--centerline-output", arguments.centerline_output,
                  "with an image or a wall as input: where to save the extracted centerline")
      ->type_name(kCenterlineFile);
  add_extraction(verb, arguments.extraction);
  add_required_coverage(verb, arguments.required_coverage);
  add_html(verb, arguments.common);
  group(verb, "Resolution",
        {"--around", "--preset", "--max-error", "--budget", "--max-vertices", "--simplification", "--elongation",
         "--ring-spacing", "--least-vertices", "--deformable"});
  group(verb, "Shape", {"--blend", "--placement", "--overlap", "--gap"});
  group(verb, "Ends", {"--ends", "--open-ends", "--flow-extensions"});
  group(verb, "How it is made", {"--growth", "--beta", "--max-center-distance", "--sweeps", "--threads"});
  group(verb, "Checks", {"--check", "--allow-defects"});
}

/// By default, a part's surface is written beside it.
void settle(GenerateArguments& arguments) {
  if (is_part(arguments.input.path) && arguments.output.empty() && arguments.input.more.empty()) {
    arguments.output = arguments.input.path;
    arguments.output.replace_extension(kPartSurfaceExtension);
  }
  settle_output(arguments);
  settle_ends(arguments.production);
}

/// What to do when nothing is within the budget.
std::string advice_beyond(const Budget& budget, const OperatingPoint& closest) {
  const bool leaves_out = closest.options.elongation > 1 && !closest.options.deformable;
  if (budget.kind != Budget::Kind::vertices || leaves_out) return "allow more, or check the radii";
  return "even triangles need " + counted(closest.vertices, "vertex", "vertices") +
         " here at the least; --elongation 4 leaves out vertices down to the budget";
}

/// The surface with the options that make the best use of the budget; `kept`: whether they keep within it.
GenerateResult grow_within_budget(GenerateReport& report, const Centerline& centerline, const GenerateOptions& options,
                                  GenerateArguments& arguments, bool& kept, Console& console) {
  BudgetedSurface surface = generate_within(*arguments.budget, centerline, options, console.progress());
  const OpenEnds open_ends = arguments.production.growth.open_ends;
  arguments.production.growth = surface.choice().options;
  arguments.production.growth.open_ends = open_ends;
  report.tried = surface.tried;
  log_choice(surface, arguments, console);
  kept = surface.met();
  if (!kept)
    warn(report,
         "nothing is within the budget " + to_string(*arguments.budget) +
             "; the closest surface is written: " + advice_beyond(*arguments.budget, surface.choice()),
         console);
  return std::move(surface.result);
}

/// Fits the surface; returns whether the requested error is kept.
bool fit(GenerateReport& report, GenerateResult& result, const PreparedCenterline& prepared, const TriMesh& reference,
         Console& console) {
  const Centerline& centerline = prepared.grown();
  Stopwatch watch;
  const FittingArguments& fitting = report.arguments->fitting;
  report.fit = naming(fit_reference(*report.arguments), [&] {
    // The wall is then fitted up to the planes in which its ends are kept.
    end_at_sections(result, sections_of_grown(prepared, report.cleaned->end_sections), false);
    const FlatReference flat = end_at_caps(result, reference);
    FitReport fitted = fit_surface(result, centerline, flat.mesh, fitting.options, console.progress());
    match_cap_areas(result, centerline, flat.caps);
    if (fitting.options.max_error > 0 && !flat.caps.empty())
      find_far_parts(fitted, {result.mesh, result.binding, result.openings}, centerline, flat.mesh,
                     fitting.options.max_error);
    return fitted;
  });
  log_fit(*report.fit, report.warnings, console);
  report.stages.push_back({"fit", watch.lap()});
  return keeps_error(*report.fit, fitting.options, report.warnings, console);
}

/// Fills in how far the surface around `grown` is from its vessels.
void measure_distance(GenerateReport& report, const Centerline& grown) {
  const GenerateResult& result = *report.result;
  stop_if_interrupted();
  const GenerateOptions& options = report.arguments->production.growth;
  const VesselField field(grown, options.blend);
  report.deviation = measure_deviation(result.mesh, result.binding, field, options.threads);
  if (!report.arguments->common.json.empty())  // reported there only
    report.rounding = measure_rounding(result.mesh, result.binding, field, VesselField(grown), options.threads);
  stop_if_interrupted();
}

/// Fills in the measurements and problems of the surface around `grown`.
void judge(GenerateReport& report, const Centerline& grown, Console& console) {
  const GenerateResult& result = *report.result;
  report.measurement = measurement_of(result);
  report.grown_nodes = grown.nodes().size();
  report.nodes_inside = result.check.nodes_inside;
  // A vessel that is not round may leave its axis outside.
  const std::size_t nodes_due = report.fit ? report.nodes_inside.value_or(0) : report.grown_nodes;
  report.problems = problems_of(report.measurement, expected_surface(grown, result), report.nodes_inside, nodes_due);
  for (const std::string& problem : report.problems) console.warn("surface: " + problem);
}

/// Adds the nearest nodes (as named in the file) and branches.
void name_nodes(std::vector<Defect>& defects, const LoadedCenterline& loaded) {
  for (Defect& defect : defects) {
    if (defect.node < loaded.cleaned.raw_node.size())
      defect.message += ", near " + loaded.file.place_of_node(loaded.cleaned.raw_node[defect.node]);
    if (defect.branch != kNone) defect.message += ", on branch " + std::to_string(defect.branch);
  }
}

SurfaceSkin bones(const GenerateResult& result, const Centerline& centerline) {
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : result.binding) places.push_back({segment, t});
  return make_linear_skin(centerline, make_rod_tree(centerline), places);
}

MeshAttributes attributes_of(const GenerateReport& report) {
  const GenerateResult& result = *report.result;
  MeshAttributes attributes =
      surface_attributes(result.mesh, result.binding, result.radius, result.openings, report.cleaned->centerline);
  if (!report.ends.ends.empty()) add_cap_labels(report.ends, attributes);
  return attributes;
}

void write(const GenerateReport& report) {
  const GenerateArguments& arguments = *report.arguments;
  const GenerateResult& result = *report.result;
  std::optional<SurfaceSkin> skin;
  if (arguments.bones) skin = bones(result, report.cleaned->centerline);
  write_surface(arguments.output, result.mesh, attributes_of(report),
                {generator_name(), describe(arguments), file_name_of(arguments.input), report.input_sha256},
                arguments.writing, skin ? &*skin : nullptr);
}

bool has_fit(const GenerateArguments& arguments) {
  return !arguments.fitting.reference.path.empty() || arguments.segmentation;
}

/// A surface that is fitted grows with even triangles.
void give_elongation_to_fit(GenerateArguments& arguments) {
  if (has_fit(arguments))
    arguments.fitting.options.elongation = std::exchange(arguments.production.growth.elongation, 1);
  arguments.fitting.options.deformable = arguments.production.growth.deformable;
}

void check_elongation(const GenerateArguments& arguments) {
  const GenerateOptions& options = arguments.production.growth;
  if (options.least_vertices > 0 && (options.elongation == 1 || options.deformable))
    throw UsageError("--least-vertices needs " + std::string(kElongationFlag) +
                     " above 1, and no --deformable: else no vertices are left out");
  if (options.elongation == 1) return;
  if (has_fit(arguments)) {
    const std::string with_fit = " cannot be combined with fitting to long triangles (" + std::string(kElongationFlag);
    if (options.least_vertices > 0)
      throw UsageError("--least-vertices" + with_fit + "): --budget vertices=N is the number of their vertices");
    if (!arguments.fitting.options.resize) throw UsageError("--keep-triangles" + with_fit + "), which changes them");
  }
  if (options.growth == GrowthMethod::paper) throw UsageError(std::string(kElongationFlag) + " needs --growth guided");
}

/// Refuses what can be refused before anything is read.
void check_arguments(const GenerateArguments& arguments) {
  using Kind = PlannedOutput::Kind;
  check_input(arguments);
  check_elongation(arguments);
  check_writing(arguments.output, arguments.writing);
  if (arguments.bones && extension_of(arguments.output) != ".glb")
    throw UsageError(arguments.output.string() + ": --bones are for .glb only");
  std::vector<PlannedOutput> outputs = {
      {arguments.output, Kind::surface}, {arguments.common.json, Kind::summary}, {arguments.common.html, Kind::page}};
  if (!arguments.centerline_output.empty()) {
    for (const std::filesystem::path& file : files_of(arguments.centerline_output))
      outputs.push_back({file, Kind::centerline});
  }
  check_outputs(outputs, files_of({&arguments.input, &arguments.fitting.reference}));
}

int run(const GenerateArguments& given, Console& console) {
  if (is_part(given.input.path)) return run_part(given, console);
  GenerateArguments arguments = given;  // a budget may change some of them
  arguments.segmentation = is_segmentation(arguments.input);
  check_arguments(arguments);
  apply_budget_to_fit(arguments);
  give_elongation_to_fit(arguments);
  Stopwatch watch;
  GenerateReport report;
  report.arguments = &arguments;

  const GenerateInput input = load_input(arguments, console);
  const LoadedCenterline& loaded = input.centerline;
  report.input_sha256 = sha256_of(arguments.input);
  report.radius_arrays = loaded.file.radius_arrays;
  report.cleaned = &loaded.cleaned;
  report.extraction = input.extraction;
  bool kept_limits = true;  // budget and error

  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline& prepared) {
    if (!report.stages.empty()) {
      console.log("that surface is not sound: growing it once more, with all nodes");
      arguments.production.growth.simplification = 0;
    }
    report.warnings = loaded.warnings;
    report.stages = input.stages;
    log_preparation(prepared, report, console);
    report.stages.push_back({prepared.separated ? "separate" : "contacts", watch.lap()});
    stop_if_interrupted();
  };
  steps.grow = [&](const Centerline& centerline, const GenerateOptions& options) {
    return naming(arguments.input.path, [&] {
      if (arguments.budget) return grow_within_budget(report, centerline, options, arguments, kept_limits, console);
      return generate_surface(centerline, options, console.progress());
    });
  };
  steps.refine = [&](GenerateResult& result, const PreparedCenterline& prepared) {
    report.result = &result;
    report.stages.insert(report.stages.end(), result.stages.begin(), result.stages.end());
    for (const GrowthWarning& warning : result.warnings) warn(report, warning.message, console);
    warn_of_error(report, console);
    if (input.reference && result.is_sound()) kept_limits &= fit(report, result, prepared, *input.reference, console);
    watch.lap();
    measure_distance(report, prepared.grown());
    return report.fit.has_value();
  };
  arguments.production.preparation.simplify = !arguments.budget;  // it decides for every trial
  const Centerline& centerline = loaded.cleaned.centerline;
  naming(arguments.input.path, [&] { check_ends(arguments.production, centerline); });
  watch.lap();
  stop_if_interrupted();
  auto [result, ends, wall_vertices, prepared] =
      produce(centerline, loaded.cleaned.end_sections, arguments.production, console.progress(), steps);
  report.result = &result;
  report.ends = std::move(ends);
  report.wall_vertices = wall_vertices;
  refer_to_original(prepared, report.contacts);
  if (report.separation) refer_to_original(prepared, *report.separation);
  for (const std::string& problem : problems_of(report.ends)) warn(report, problem, console);
  name_nodes(result.defects, loaded);
  judge(report, prepared.grown(), console);
  report.stages.push_back({"measure", watch.lap()});
  if (!result.is_sound() && !arguments.allow_defects) {
    log_refusal(report, console);
    return kDefective;
  }

  write(report);
  report.stages.push_back({"write", watch.lap()});
  log_result(report, console);
  if (!arguments.common.json.empty()) write_json(arguments.common.json, to_json(report));
  if (!arguments.common.html.empty()) {
    const TriMesh* fitted_to = input.reference ? &*input.reference : nullptr;
    write_page(arguments.common.html, page_of(report, prepared.grown(), attributes_of(report), fitted_to), console);
  }
  if (input.extraction && !meets(arguments.required_coverage, *input.extraction, console)) return kCheckFailed;
  if (arguments.check && !report.problems.empty()) return kCheckFailed;
  return result.error.unproven_faces > 0 || !kept_limits ? kNotConverged : kOk;
}

const VerbRegistration<GenerateArguments> kRegistration({
    .rank = 10,
    .name = "generate",
    .help = "Grow a surface around a centerline",
    .examples = R"(Examples:
  vmesh generate tree.swc -o tree.ply
  vmesh generate tree.vtp -o tree.vtp --around 8 --blend 0.8 --json summary.json
  vmesh generate network.csv -o network.stl --unit um --check
  vmesh generate branch-*.mrk.json -o tree.ply
  vmesh generate tree.vtk -o tree.ply --radius-array Thickness
  vmesh generate aorta.pth -o aorta.ply --unit cm --radius 9
  vmesh generate tree.swc -o fine.ply --preset high
  vmesh generate tree.swc -o exact.ply --max-error 5%
  vmesh generate tree.swc -o game.obj --budget vertices=5000
  vmesh generate portal.swc -o portal.ply --fit liver.nii.gz --label 2 --spacing 1 --smooth 1
  vmesh generate liver.nii.gz --label 2 --spacing 1 --smooth 1 --tree -o portal.ply --centerline-output portal.swc
  vmesh generate aorta.vtp -o aorta-flow.vtp --ends flat --flow-extensions auto --json caps.json
  vmesh generate tree.swc tree.glb --bones
  vmesh generate tree.swc -o tree.ply --html tree.html
  vmesh generate crowded.swc -o crowded.ply --overlap separate --gap 0.2)",
    .add_options = add_options,
    .settle = settle,
    .threads = [](const GenerateArguments& arguments) { return arguments.production.growth.threads; },
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::generate_verb
