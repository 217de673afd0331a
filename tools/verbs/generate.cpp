#include "vmesh/deform/linear_skin.h"
#include "vmesh/fit/flat_reference.h"
#include "vmesh/surface/surface_attributes.h"
#include "vmesh/volume/vessel_field.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/fit_report.h"
#include "report/generate_log.h"
#include "report/pages.h"
#include "report/summary.h"
#include "verbs/extraction.h"
#include "verbs/generate_input.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

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
             "; the closest surface is written: allow more, or check the radii",
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
    return fitted;
  });
  log_fit(*report.fit, report.warnings, console);
  report.stages.push_back({"fit", watch.lap()});
  return keeps_error(*report.fit, fitting.options.error, report.warnings, console);
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

void warn_of_ends(GenerateReport& report, Console& console) {
  for (const SectionNotKept& end : report.ends.not_kept)
    warn(report,
         "the flat end at node " + std::to_string(end.node) + " is not kept: " + end.reason +
             "; the vessel is cut across its axis there",
         console);
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
      defect.message += ", nearest to " + loaded.file.place_of_node(loaded.cleaned.raw_node[defect.node]);
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

/// Fitting makes triangles even again.
void check_elongation(const GenerateArguments& arguments) {
  const GenerateOptions& options = arguments.production.growth;
  if (options.least_vertices > 0 && (options.elongation == 1 || options.deformable))
    throw UsageError("--least-vertices needs " + std::string(kElongationFlag) +
                     " above 1, and no --deformable: else no vertices are left out");
  if (options.elongation == 1) return;
  if (!arguments.fitting.reference.path.empty() || arguments.segmentation)
    throw UsageError(std::string(kElongationFlag) + " cannot be combined with fitting, which makes triangles even");
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
  std::vector<std::filesystem::path> inputs = files_of(arguments.input);
  if (!arguments.fitting.reference.path.empty()) {
    for (const std::filesystem::path& file : files_of_input(arguments.fitting.reference.path)) inputs.push_back(file);
  }
  check_outputs(outputs, inputs);
}

}  // namespace

int run(const GenerateArguments& given, Console& console) {
  if (is_part(given.input.path)) return run_part(given, console);
  GenerateArguments arguments = given;  // a budget may change some of them
  arguments.segmentation = is_segmentation(arguments.input);
  check_arguments(arguments);
  apply_budget_to_fit(arguments);
  Stopwatch watch;
  GenerateReport report;
  report.arguments = &arguments;

  const GenerateInput input = load_input(arguments, console);
  const auto& [loaded, reference, extraction, read_stages] = input;
  report.input_sha256 = sha256_of(arguments.input);
  report.cleaned = &loaded.cleaned;
  report.extraction = extraction;
  bool kept_limits = true;  // budget and error

  ProductionSteps steps;
  steps.prepared = [&](const PreparedCenterline& prepared) {
    if (!report.stages.empty()) {
      console.log("that surface is not sound: growing it once more, with all nodes");
      arguments.production.growth.simplification = 0;
    }
    report.warnings = loaded.warnings;
    report.stages = read_stages;
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
    if (reference && result.is_sound()) kept_limits &= fit(report, result, prepared, *reference, console);
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
  warn_of_ends(report, console);
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
    const TriMesh* fitted_to = reference ? &*reference : nullptr;
    write_page(arguments.common.html, page_of(report, prepared.grown(), attributes_of(report), fitted_to), console);
  }
  if (extraction && !meets(arguments.required_coverage, *extraction, console)) return kCheckFailed;
  if (arguments.check && !report.problems.empty()) return kCheckFailed;
  return result.error.unproven_faces > 0 || !kept_limits ? kNotConverged : kOk;
}

}  // namespace vmesh::tool
