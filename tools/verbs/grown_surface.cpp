#include "verbs/grown_surface.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "vmesh/core/memory.h"
#include "vmesh/core/text.h"
#include "vmesh/mesh/patch_names.h"
#include "vmesh/surface/flat_reference.h"
#include "vmesh/surface/surface_attributes.h"
#include "vmesh/volume/vessel_field.h"

#include "command_line/arguments_common.h"
#include "command_line/arguments_growth.h"
#include "command_line/interrupt.h"
#include "report/fit_report.h"
#include "report/generate_log.h"
#include "verbs/end_names.h"
#include "verbs/fitting.h"

namespace vmesh::tool {
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

bool has_fit(const GenerateArguments& arguments) {
  return !arguments.fitting.reference.path.empty() || arguments.segmentation;
}

/// A surface that is fitted grows with even triangles.
void give_elongation_to_fit(GenerateArguments& arguments) {
  if (has_fit(arguments))
    arguments.fitting.options.elongation = std::exchange(arguments.production.growth.elongation, 1);
  arguments.fitting.options.deformable = arguments.production.growth.deformable;
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
  release_freed_memory();
  {
    const VesselField field(grown, options.blend);
    report.deviation = measure_deviation(result.mesh, result.binding, field, options.threads);
    if (!report.arguments->common.json.empty())  // reported there only
      report.rounding = measure_rounding(result.mesh, result.binding, field, options.threads);
  }
  release_freed_memory();
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

/// The number of patches that are walls.
Index wall_patches_of(const MeshAttributes& attributes) {
  const std::vector<std::string>& names = attributes.patch_names;
  return static_cast<Index>(std::count_if(names.begin(), names.end(), is_wall_name));
}

/// Adds the nearest nodes (as named in the file) and branches.
void name_nodes(std::vector<Defect>& defects, const LoadedCenterline& loaded) {
  for (Defect& defect : defects) {
    if (defect.node < loaded.cleaned.raw_node.size())
      defect.message += ", near " + loaded.file.place_of_node(loaded.cleaned.raw_node[defect.node]);
    if (defect.branch != kNone) defect.message += ", on branch " + std::to_string(defect.branch);
  }
}

}  // namespace

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

void settle_ends(ProductionOptions& options) {
  OpenEnds& open = options.growth.open_ends;
  if (options.extension > 0 && options.ends == EndShape::round && !open.all && open.nodes.empty())
    throw UsageError("--flow-extensions needs ends that are not round: --ends flat, or --ends open");
  if (options.ends == EndShape::round || !open.all) return;
  options.ends = EndShape::open;
  open = {};
}

void check_growth(const GenerateArguments& arguments) {
  const GenerateOptions& options = arguments.production.growth;
  if (!arguments.end_names.empty() && arguments.production.ends == EndShape::round)
    throw UsageError("--name and --names are for ends that are not round: --ends flat, or --ends open");
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

MeshAttributes GrownSurface::attributes() const {
  MeshAttributes attributes = surface_attributes(result().mesh, result().binding, result().radius, result().openings,
                                                 report.cleaned->centerline);
  if (!report.ends.ends.empty()) add_cap_labels(report.ends, attributes, report.end_names);
  if (arguments.wall_by_branch) divide_wall(attributes);
  return attributes;
}

AttributeBlocks GrownSurface::attribute_blocks() const {
  return {result().mesh, result().binding, result().radius, result().openings, report.cleaned->centerline};
}

std::unique_ptr<GrownSurface> grow_surface(const GenerateArguments& given, Console& console) {
  auto grown = std::make_unique<GrownSurface>(given);
  GenerateArguments& arguments = grown->arguments;
  GenerateReport& report = grown->report;
  apply_budget_to_fit(arguments);
  give_elongation_to_fit(arguments);
  Stopwatch watch;
  report.arguments = &arguments;

  grown->input = load_input(arguments, console);
  const GenerateInput& input = grown->input;
  const LoadedCenterline& loaded = input.centerline;
  report.input_sha256 = sha256_of(arguments.input);
  report.radius_arrays = loaded.file.radius_arrays;
  report.cleaned = &loaded.cleaned;
  report.extraction = input.extraction;

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
      if (arguments.budget)
        return grow_within_budget(report, centerline, options, arguments, grown->kept_limits, console);
      return generate_surface(centerline, options, console.progress());
    });
  };
  steps.refine = [&](GenerateResult& result, const PreparedCenterline& prepared) {
    report.result = &result;
    report.stages.insert(report.stages.end(), result.stages.begin(), result.stages.end());
    for (const GrowthWarning& warning : result.warnings) warn(report, warning.message, console);
    warn_of_error(report, console);
    if (input.reference && result.is_sound())
      grown->kept_limits &= fit(report, result, prepared, *input.reference, console);
    watch.lap();
    measure_distance(report, prepared.grown());
    return report.fit.has_value();
  };
  arguments.production.preparation.simplify = !arguments.budget;  // it decides for every trial
  const Centerline& centerline = loaded.cleaned.centerline;
  naming(arguments.input.path, [&] { check_ends(arguments.production, centerline); });
  report.end_names = read_end_names(arguments.end_names, centerline);
  watch.lap();
  stop_if_interrupted();
  grown->production = produce(centerline, loaded.cleaned.end_sections, arguments.production, console.progress(), steps);
  auto& [result, ends, wall_vertices, prepared] = grown->production;
  report.result = &result;
  report.ends = ends;
  report.wall_vertices = wall_vertices;
  if (arguments.wall_by_branch) report.wall_patches = wall_patches_of(grown->attributes());
  refer_to_original(prepared, report.contacts);
  if (report.separation) refer_to_original(prepared, *report.separation);
  for (const std::string& problem : problems_of(report.ends)) warn(report, problem, console);
  name_nodes(result.defects, loaded);
  judge(report, prepared.grown(), console);
  report.stages.push_back({"measure", watch.lap()});
  return grown;
}

}  // namespace vmesh::tool
