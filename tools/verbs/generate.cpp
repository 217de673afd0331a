#include "vmesh/core/text.h"
#include "vmesh/deform/linear_skin.h"
#include "vmesh/parts/part_files.h"

#include "command_line/arguments_growth.h"
#include "command_line/arguments_segmentation.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/generate_log.h"
#include "report/pages.h"
#include "verbs/end_names.h"
#include "verbs/extraction.h"
#include "verbs/grown_surface.h"
#include "verbs/part.h"

namespace vmesh::tool::generate_verb {
namespace {

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
  add_end_names(verb, arguments.end_names);
  add_regions(
      verb, [&arguments] { arguments.wall_by_branch = true; },
      "divide the wall into a patch for each branch, wall_0, wall_1 ... by their numbers (branch); caps are numbered "
      "after them");
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
  group(verb, "Ends", {"--ends", "--open-ends", "--flow-extensions", "--name", "--names", "--regions"});
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

SurfaceSkin bones(const GenerateResult& result, const Centerline& centerline) {
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : result.binding) places.push_back({segment, t});
  return make_linear_skin(centerline, make_rod_tree(centerline), places);
}

void write(const GrownSurface& grown) {
  const GenerateReport& report = grown.report;
  const GenerateArguments& arguments = *report.arguments;
  const GenerateResult& result = *report.result;
  const SurfaceMetadata metadata = {generator_name(), describe(arguments), file_name_of(arguments.input),
                                    report.input_sha256};
  if (grown.has_plain_attributes() && can_be_written_by_blocks(arguments.output, arguments.writing)) {
    write_by_blocks(arguments.output, result.mesh, grown.attribute_blocks(), metadata);
    return;
  }
  std::optional<SurfaceSkin> skin;
  if (arguments.bones) skin = bones(result, report.cleaned->centerline);
  write_surface(arguments.output, result.mesh, grown.attributes(), metadata, arguments.writing,
                skin ? &*skin : nullptr);
}

/// Refuses what can be refused before anything is read.
void check_arguments(const GenerateArguments& arguments) {
  using Kind = PlannedOutput::Kind;
  check_input(arguments);
  check_growth(arguments);
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
  GenerateArguments settled = given;
  settled.segmentation = is_segmentation(settled.input);
  check_arguments(settled);
  const auto grown = grow_surface(settled, console);
  const GenerateArguments& arguments = grown->arguments;
  GenerateReport& report = grown->report;
  Stopwatch watch;
  if (!grown->result().is_sound() && !arguments.allow_defects) {
    log_refusal(report, console);
    return kDefective;
  }

  write(*grown);
  report.stages.push_back({"write", watch.lap()});
  log_result(report, console);
  if (!arguments.common.json.empty()) write_json(arguments.common.json, to_json(report));
  if (!arguments.common.html.empty()) {
    const TriMesh* fitted_to = grown->input.reference ? &*grown->input.reference : nullptr;
    write_page(arguments.common.html,
               page_of(report, grown->production.prepared.grown(), grown->attributes(), fitted_to), console);
  }
  if (const auto& extraction = grown->input.extraction;
      extraction && !meets(arguments.required_coverage, *extraction, console))
    return kCheckFailed;
  if (arguments.check && !report.problems.empty()) return kCheckFailed;
  return grown->result().error.unproven_faces > 0 || !grown->kept_limits ? kNotConverged : kOk;
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
  vmesh generate y.swc -o y.vtp --ends flat --name 0=inlet --name 3=outlet_left --name 5=outlet_right
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
