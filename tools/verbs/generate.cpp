#include <algorithm>
#include <cmath>

#include "vmesh/centerline/branches.h"
#include "vmesh/deform/linear_skin.h"
#include "vmesh/fit/flat_reference.h"
#include "vmesh/io/sha256.h"
#include "vmesh/surface/branch_labels.h"
#include "vmesh/volume/vessel_field.h"

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/fit_report.h"
#include "report/summary.h"
#include "report/surface_attributes.h"
#include "verbs/fitting.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

std::string number(double value, int digits = 3) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string percent(double share) { return number(100 * share, 0) + " %"; }

/// As SimVascular has them: the wall is face 1, and no cap.
void add_cap_labels(const FlatEnds& ends, MeshAttributes& attributes) {
  MeshAttribute face{"ModelFaceID", {}, true}, cap{"CapID", {}, true};
  for (const Index label : ends.cap_label) {
    face.values.push_back(1.0 + label);
    cap.values.push_back(label > 0 ? label : -1.0);
  }
  attributes.face.push_back(std::move(face));
  attributes.face.push_back(std::move(cap));
}

std::string text_of(const Vec3& p) { return "(" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ")"; }

void tell_of_notches(const ErrorSummary& error, Console& console) {
  if (error.closed_notches.empty()) return;
  const ClosedNotch& deepest = error.closed_notches.front();
  const std::size_t count = error.closed_notches.size();
  console.log(std::to_string(count) + (count == 1 ? " notch" : " notches") +
              " closed, too narrow for triangles across; the limit counts that: the deepest by " +
              number(deepest.depth) + " mm at " + text_of(deepest.position));
}

void log_result(const GenerateReport& report, Console& console) {
  const TriMesh& mesh = report.result->mesh;
  const double size = report.cleaned->centerline.length_in_radii();
  std::string vertices = std::to_string(mesh.vertices.size()) + " vertices";
  if (size > 0)
    vertices += " (" + number(static_cast<double>(mesh.vertices.size()) / size, 1) + " per radius of length)";
  console.log(vertices + ", " + std::to_string(mesh.faces.size()) + " faces, skewness " +
              number(report.measurement.skewness.mean) + " mean, " + number(report.measurement.skewness.max) + " max");
  console.log("distance to the volume " + number(report.deviation.mean_relative) + " mean, " +
              number(report.deviation.max_relative) + " max, in local radii");
  const ErrorLimit& limit = report.arguments->options.max_error;
  if (limit.is_set() && report.result->error.unproven_faces == 0)
    console.log("proven: nowhere farther than " + to_string(limit) + " from the boundary, nor the boundary from it");
  tell_of_notches(report.result->error, console);
  double total = 0;
  for (const StageTime& stage : report.stages) total += stage.seconds;
  console.log("wrote " + report.arguments->output.string() + " after " + number(total, 2) + " s");
}

std::string places(const std::vector<Contact>& contacts) {
  return std::to_string(contacts.size()) + (contacts.size() == 1 ? " place" : " places");
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

void warn_of_error(GenerateReport& report, Console& console) {
  const ErrorSummary& error = report.result->error;
  if (error.unproven_faces == 0) return;
  constexpr std::size_t kNamed = 5;
  std::string text = "the surface may be farther than " + to_string(report.arguments->options.max_error) +
                     " from the boundary, or the boundary from it, at " + std::to_string(error.unproven_faces) +
                     " faces in " + std::to_string(error.unproven_places.size()) + " places, the largest at ";
  for (std::size_t i = 0; i < std::min(kNamed, error.unproven_places.size()); ++i)
    text += (i > 0 ? ", " : "") + text_of(error.unproven_places[i].position);
  text += ": triangles became as small as they may; allow more there, or look at the radii";
  console.warn(text);
  report.warnings.push_back(text);
}

LoadedCenterline load(const InputArguments& input, Console& console) {
  LoadedCenterline loaded = load_clean_centerline(input, console);
  const Centerline& centerline = loaded.cleaned.centerline;
  console.log(std::to_string(centerline.nodes().size()) + " nodes, " + std::to_string(centerline.segments().size()) +
              " segments, " + std::to_string(centerline.component_count()) + " components, " +
              std::to_string(centerline.cycle_rank()) + " loops");
  return loaded;
}

/// The centerline of the vessels in an image, and their surface, which is what the one that grows is fitted to.
LoadedCenterline extract(GenerateArguments& arguments, std::optional<TriMesh>& reference, Console& console) {
  FittingArguments image = arguments.fitting;
  image.reference = arguments.input;
  TriMesh surface = load_fit_reference(image, console);
  stop_if_interrupted();
  const ExtractedCenterline extracted = naming(
      arguments.input.path, [&] { return extract_centerline(surface, arguments.extraction, console.progress()); });
  const Centerline& centerline = extracted.centerline;
  console.log(std::to_string(centerline.nodes().size()) + " nodes, " + std::to_string(centerline.segments().size()) +
              " segments, " + std::to_string(centerline.component_count()) + " components, " +
              std::to_string(centerline.cycle_rank()) + " loops extracted");
  if (!arguments.centerline_output.empty())
    write_centerline(arguments.centerline_output, centerline,
                     {generator_name(), "extracted by generate", arguments.input.path.filename().string(),
                      sha256_of_file(arguments.input.path)});
  if (!reference) reference = std::move(surface);
  LoadedCenterline loaded{{centerline, {}, {}, {}}, {}, {}};
  for (Index n = 0; n < centerline.nodes().size(); ++n) loaded.cleaned.raw_node.push_back(n);
  for (Index s = 0; s < centerline.segments().size(); ++s) loaded.cleaned.raw_segment.push_back(s);
  return loaded;
}

bool has_image(const GenerateArguments& arguments) { return is_image_path(arguments.input.path); }

/// Leaves out the nodes that the surface does not need. Without a value all are needed; or the budget decides, for
/// every surface that is tried, which are.
std::optional<SimplifiedCenterline> simplify(const Centerline& centerline, const GenerateArguments& arguments,
                                             Console& console) {
  const GenerateOptions& options = arguments.options;
  if (arguments.budget || options.growth == GrowthMethod::paper || options.simplification == 0) return std::nullopt;
  std::optional<SimplifiedCenterline> simplified = simplify_for_growth(centerline, options);
  if (!simplified->is_simpler()) return std::nullopt;
  console.log(std::to_string(simplified->node.size()) + " of the nodes steer the surface; without the others the " +
              "vessels are the same up to " + number(100 * simplified->max_deviation_relative, 1) +
              " % of their radius");
  return simplified;
}

/// Finds where vessels touch and, when asked to, narrows or moves them. Without a value the vessels stay as they are.
std::optional<SeparatedCenterline> handle_contacts(GenerateReport& report, const Centerline& centerline,
                                                   Console& console) {
  const GenerateArguments& arguments = *report.arguments;
  const auto warn = [&](const std::string& line) {
    console.warn(line);
    report.warnings.push_back(line);
  };
  if (arguments.overlap == OverlapHandling::keep) {
    report.contacts = find_contacts(VesselField(centerline, arguments.options.blend), arguments.gap);
    if (report.contacts.empty()) return std::nullopt;
    warn("vessels that are not neighbours touch in " + places(report.contacts) + ", the deepest " +
         describe(report.contacts.front()) +
         "; there the surface intersects itself, and is refused unless --allow-defects (--overlap separate, the "
         "default, "
         "narrows them, and moves those that cross)");
    return std::nullopt;
  }
  SeparationOptions options;
  options.gap = arguments.gap;
  options.blend = arguments.options.blend;
  SeparatedCenterline separated = separate_contacts(centerline, options, console.progress());
  const SeparationReport& separation = separated.report;
  report.contacts = separation.before;
  if (separation.nodes_narrowed > 0) {
    console.log("vessels that are not neighbours touched in " + places(separation.before) + "; " +
                std::to_string(separation.nodes_narrowed) + " nodes were narrowed, by " +
                percent(separation.mean_taken_relative) + " of the radius in the mean, " +
                percent(separation.max_taken_relative) + " (" + number(separation.max_taken) + " mm) at most");
  }
  if (separation.nodes_moved > 0) {
    const std::size_t moves = separation.moves.size();
    console.log("vessels were moved aside in " + std::to_string(moves) + (moves == 1 ? " place" : " places") +
                " where they cross or nearly do: " + std::to_string(separation.nodes_moved) + " nodes, by " +
                number(separation.max_moved) + " mm, " + number(separation.max_moved_relative, 2) +
                " radii at most, the farthest at " + text_of(separation.max_moved_at));
  }
  constexpr std::size_t kNamed = 5;
  for (std::size_t c = 0; c < std::min(kNamed, separation.left.size()); ++c) {
    warn("vessels still touch " + describe(separation.left[c]) +
         "; neither narrowing nor a small move can part them: move the nodes of one, or join them if they are one "
         "vessel");
  }
  if (separation.left.size() > kNamed)
    warn("vessels still touch in " + places(separation.left) + "; the summary lists them");
  report.separation = separation;
  return separated;
}

/// A binding to segments of a separated centerline, as one to those of the original.
std::vector<CenterlineBinding> original_binding(const std::vector<CenterlineBinding>& binding,
                                                const SeparatedCenterline& separated, const Centerline& original) {
  std::vector<CenterlineBinding> result;
  result.reserve(binding.size());
  for (const auto& [segment, t] : binding) {
    if (segment < separated.pieces.size()) {
      const SegmentPiece& piece = separated.pieces[segment];
      result.push_back({piece.segment, piece.original_t(t)});
    } else {  // an isolated node
      result.push_back({static_cast<Index>(segment - separated.pieces.size() + original.segments().size()), t});
    }
  }
  return result;
}

/// Nodes and segments of a separated centerline, as those of the original; nodes that were added are left out.
void renumber(std::vector<Defect>& defects, const SeparatedCenterline& separated, const Centerline& original) {
  const std::vector<Branch> branches = find_branches(original);
  for (Defect& defect : defects) {
    if (defect.segment < separated.pieces.size()) defect.segment = separated.pieces[defect.segment].segment;
    if (defect.node >= original.nodes().size()) defect.node = kNone;
    defect.branch = kNone;
    for (Index b = 0; b < branches.size(); ++b) {
      const auto& segments = branches[b].segments;
      if (std::find(segments.begin(), segments.end(), defect.segment) != segments.end()) defect.branch = b;
    }
  }
}

void renumber(GrowthSummary& growth, const SeparatedCenterline& separated, const Centerline& original) {
  for (GrowthSimplification& note : growth.simplifications) {
    std::erase_if(note.nodes, [&](Index n) { return n >= original.nodes().size(); });
    for (Index& s : note.segments) s = separated.pieces[s].segment;
    std::sort(note.segments.begin(), note.segments.end());
    note.segments.erase(std::unique(note.segments.begin(), note.segments.end()), note.segments.end());
  }
}

void refer_to_original(const SimplifiedCenterline& simplified, ContactSide& side) {
  const auto [segment, t] = simplified.original(side.segment, side.t);
  side.segment = segment;
  side.t = t;
}

/// Contacts and moves of a simplified centerline, as those of the original. Branches are the same.
void refer_to_original(const SimplifiedCenterline& simplified, GenerateReport& report) {
  const auto refer = [&](std::vector<Contact>& contacts) {
    for (Contact& contact : contacts) {
      for (ContactSide& side : contact.sides) refer_to_original(simplified, side);
    }
  };
  refer(report.contacts);
  if (!report.separation) return;
  refer(report.separation->before);
  refer(report.separation->left);
  for (VesselMove& move : report.separation->moves) {
    refer_to_original(simplified, move.moved);
    refer_to_original(simplified, move.other);
  }
}

void log_choice(const BudgetedSurface& surface, const GenerateArguments& arguments, Console& console) {
  console.log("for " + to_string(*arguments.budget) + " there were:");
  for (const OperatingPoint& point : surface.tried) {
    console.log(std::string(&point == &surface.choice() ? "* " : "  ") + std::to_string(point.options.around) +
                " around: " + std::to_string(point.vertices) + " vertices, " + number(point.seconds) + " s, distance " +
                number(point.error.mean_relative) + " mean, " + number(point.error.max_relative) + " max (" +
                number(point.error.max_mm) + " mm), skewness " + number(point.skewness.mean) + " mean, " +
                number(point.skewness.max) + " max" + (point.within_budget ? "" : "; beyond the budget"));
  }
  std::string inputs = arguments.input.path.string();
  for (const std::filesystem::path& path : arguments.input.more) inputs += " " + path.string();
  console.log("the same again: vmesh generate " + inputs + " -o " + arguments.output.string() + " " +
              describe(arguments));
}

/// Chooses the options that make the most of the budget.
BudgetedSurface grow_within_budget(GenerateReport& report, const Centerline& centerline, GenerateArguments& arguments,
                                   Console& console) {
  BudgetedSurface surface = naming(arguments.input.path, [&] {
    return generate_within(*arguments.budget, centerline, arguments.options, console.progress());
  });
  arguments.options = surface.choice().options;
  report.tried = surface.tried;
  log_choice(surface, arguments, console);
  if (!surface.met()) {
    const std::string text = "nothing keeps to the budget " + to_string(*arguments.budget) +
                             "; the surface written is what comes closest: allow more, or look at the radii";
    console.warn(text);
    report.warnings.push_back(text);
  }
  return surface;
}

/// What only an image or a reference gives a meaning to.
void check_input(const GenerateArguments& arguments) {
  const ReferenceOptions& image = arguments.fitting.image;
  const bool fits = !arguments.fitting.reference.path.empty();
  if (has_image(arguments)) {
    if (!arguments.input.more.empty())
      throw UsageError(arguments.input.more.front().string() + ": beside an image nothing else makes a centerline");
    if (fits && has_options(image) && is_image_path(arguments.fitting.reference.path))
      throw UsageError(
          "--label, --threshold, --spacing and --smooth would be for two images; extract the centerline "
          "first (vmesh centerline), or leave --fit out: the surface is fitted to the image it is from");
    return;
  }
  if (!arguments.centerline_output.empty())
    throw UsageError("--centerline-output is for an input that is an image; this is taken for a centerline");
  const ExtractOptions plain;
  if (arguments.extraction.tree || arguments.extraction.spacing != plain.spacing ||
      arguments.extraction.join != plain.join)
    throw UsageError("--step, --join and --tree are for an input that is an image; this is taken for a centerline");
  if (fits) return;
  if (arguments.fitting.options.error > 0) throw UsageError("--fit-error needs --fit REFERENCE");
  if (has_options(image))
    throw UsageError("--label, --threshold, --spacing and --smooth are for images; none is given");
}

void check_left_open(const GenerateArguments& arguments, const Centerline& centerline) {
  for (const Index n : arguments.left_open) {
    if (n >= centerline.nodes().size() || centerline.degree(n) != 1)
      throw InvalidInput(arguments.input.path.string() + ": node " + std::to_string(n) +
                         " cannot be left open: it is not an end of the centerline");
  }
}

/// With a reference, a budget is the fit's: of vertices or of the distance to the reference.
void apply_budget_to_fit(GenerateArguments& arguments) {
  FittingArguments& fitting = arguments.fitting;
  if (fitting.reference.path.empty() && !has_image(arguments)) return;
  if (arguments.options.max_error.is_set())
    throw UsageError("--max-error is a limit on the distance to round cones; with --fit see --fit-error");
  fitting.options.threads = arguments.options.threads;
  if (!arguments.budget) return;
  const Budget budget = *arguments.budget;
  if (budget.kind == Budget::Kind::vertices) {
    fitting.options.max_vertices = budget.vertices;  // what is grown keeps to it as well
    return;
  }
  if (budget.kind != Budget::Kind::error || !std::isfinite(budget.error.mm) || std::isfinite(budget.error.relative))
    throw UsageError("--fit takes budgets such as vertices=5000 and error=0.2mm, not " + to_string(budget));
  fitting.options.error = budget.error.mm;
  arguments.budget.reset();
}

const std::filesystem::path& fit_reference(const GenerateArguments& arguments) {
  const std::filesystem::path& path = arguments.fitting.reference.path;
  return path.empty() ? arguments.input.path : path;
}

/// Returns whether the error that was asked for is kept.
bool fit(GenerateReport& report, GenerateResult& result, const Centerline& centerline, const TriMesh& reference,
         Console& console) {
  Stopwatch watch;
  const FittingArguments& fitting = report.arguments->fitting;
  report.fit = naming(fit_reference(*report.arguments), [&] {
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
  const GenerateOptions& options = report.arguments->options;
  const VesselField field(grown, options.blend);
  report.deviation = measure_deviation(result.mesh, result.binding, field, options.threads);
  if (!report.arguments->common.json.empty())  // nothing else tells of it
    report.rounding = measure_rounding(result.mesh, result.binding, field, VesselField(grown), options.threads);
  stop_if_interrupted();
}

/// Caps and extends ends, whose nodes are those of the original centerline.
void finish_ends(GenerateReport& report, GenerateResult& result) {
  const GenerateArguments& arguments = *report.arguments;
  const Centerline& centerline = report.cleaned->centerline;
  if (result.openings.empty() && arguments.ends == EndShape::round) return;
  FlatEndOptions options;
  options.cap = arguments.ends == EndShape::flat;
  options.left_open = arguments.left_open;
  options.extension = arguments.flow_extension;
  options.keep_area = !report.fit && arguments.options.placement == Placement::balanced;
  report.ends = vmesh::finish_ends(result, centerline, options);
}

/// Fills in what the surface around `grown` is like and what is wrong with it.
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

/// Adds the nodes that are nearest, as the file names them, and the branches.
void name_nodes(std::vector<Defect>& defects, const LoadedCenterline& loaded) {
  for (Defect& defect : defects) {
    if (defect.node < loaded.cleaned.raw_node.size())
      defect.message += ", nearest to " + loaded.file.place_of_node(loaded.cleaned.raw_node[defect.node]);
    if (defect.branch != kNone) defect.message += ", on branch " + std::to_string(defect.branch);
  }
}

/// Says why nothing is written.
void refuse(const GenerateReport& report, Console& console) {
  constexpr std::size_t kNamed = 8;
  const std::vector<Defect>& defects = report.result->defects;
  for (std::size_t i = 0; i < std::min(kNamed, defects.size()); ++i)
    console.error(std::string(to_string(defects[i].kind)) + ": " + defects[i].message);
  if (defects.size() > kNamed) console.error("and " + std::to_string(defects.size() - kNamed) + " defects more");
  console.error(report.arguments->input.path.string() +
                ": no sound surface was found, nothing is written: look at the radii and nodes there, try another "
                "--around or --blend, or take the surface as it is with --allow-defects");
}

SurfaceSkin bones(const GenerateResult& result, const Centerline& centerline) {
  std::vector<SurfacePlace> places;
  for (const auto& [segment, t] : result.binding) places.push_back({segment, t});
  return make_linear_skin(centerline, make_rod_tree(centerline), places);
}

void write(const GenerateReport& report) {
  const GenerateArguments& arguments = *report.arguments;
  const GenerateResult& result = *report.result;
  MeshAttributes attributes =
      surface_attributes(result.mesh, result.binding, result.radius, result.openings, report.cleaned->centerline);
  if (!report.ends.ends.empty()) add_cap_labels(report.ends, attributes);
  std::optional<SurfaceSkin> skin;
  if (arguments.bones) skin = bones(result, report.cleaned->centerline);
  write_surface(arguments.output, result.mesh, std::move(attributes),
                {generator_name(), describe(arguments), file_name_of(arguments.input), report.input_sha256},
                arguments.writing, skin ? &*skin : nullptr);
}

}  // namespace

int run(const GenerateArguments& given, Console& console) {
  using Kind = PlannedOutput::Kind;
  check_input(given);
  check_writing(given.output, given.writing);
  if (given.bones && extension_of(given.output) != ".glb")
    throw UsageError(given.output.string() + ": --bones are for .glb only");
  std::vector<PlannedOutput> outputs = {{given.output, Kind::surface}, {given.common.json, Kind::summary}};
  if (!given.centerline_output.empty()) {
    for (const std::filesystem::path& file : files_of(given.centerline_output))
      outputs.push_back({file, Kind::centerline});
  }
  std::vector<std::filesystem::path> inputs = files_of(given.input);
  if (!given.fitting.reference.path.empty()) inputs.push_back(given.fitting.reference.path);
  check_outputs(outputs, inputs);
  GenerateArguments arguments = given;  // a budget chooses some of them
  Stopwatch watch;
  GenerateReport report;
  report.arguments = &arguments;
  apply_budget_to_fit(arguments);

  std::optional<TriMesh> reference;
  if (!arguments.fitting.reference.path.empty()) {
    FittingArguments fitting = arguments.fitting;
    if (has_image(arguments) && !is_image_path(fitting.reference.path)) fitting.image = {};  // the input's
    reference = load_fit_reference(fitting, console);
  }
  const LoadedCenterline loaded =
      has_image(arguments) ? extract(arguments, reference, console) : load(arguments.input, console);
  report.input_sha256 = sha256_of(arguments.input);
  report.cleaned = &loaded.cleaned;
  report.stages.push_back({"read", watch.lap()});
  stop_if_interrupted();

  append(report.warnings, loaded.warnings);
  check_left_open(arguments, loaded.cleaned.centerline);
  const std::optional<SimplifiedCenterline> simplified = simplify(loaded.cleaned.centerline, arguments, console);
  const Centerline& original = simplified ? simplified->centerline : loaded.cleaned.centerline;
  const std::optional<SeparatedCenterline> separated = handle_contacts(report, original, console);
  const Centerline& centerline = separated ? separated->centerline : original;
  report.stages.push_back({separated ? "separate" : "contacts", watch.lap()});
  stop_if_interrupted();

  bool kept_budget = true;
  GenerateResult result;
  const GenerateOptions growth_options = naming(arguments.input.path, [&] {
    return simplified ? after_simplification(arguments.options, *simplified) : arguments.options;
  });
  if (arguments.budget) {
    BudgetedSurface surface = grow_within_budget(report, centerline, arguments, console);
    kept_budget = surface.met();
    result = std::move(surface.result);
  } else {
    result =
        naming(arguments.input.path, [&] { return generate_surface(centerline, growth_options, console.progress()); });
  }
  if (simplified && !result.is_sound()) {
    console.log("that surface is not sound: once more, with all nodes");
    arguments.options.simplification = 0;
    return run(arguments, console);
  }
  report.result = &result;
  report.stages.insert(report.stages.end(), result.stages.begin(), result.stages.end());
  for (const GrowthWarning& warning : result.warnings) {
    console.warn(warning.message);
    report.warnings.push_back(warning.message);
  }
  warn_of_error(report, console);
  if (reference && result.is_sound()) kept_budget &= fit(report, result, centerline, *reference, console);

  watch.lap();
  measure_distance(report, centerline);
  if (separated) {
    result.binding = original_binding(result.binding, *separated, original);
    renumber(result.growth, *separated, original);
    renumber(result.defects, *separated, original);
  }
  if (simplified) {
    vmesh::refer_to_original(*simplified, result);
    refer_to_original(*simplified, report);
  }
  finish_ends(report, result);
  name_nodes(result.defects, loaded);
  judge(report, centerline, console);
  report.stages.push_back({"measure", watch.lap()});
  if (!result.is_sound() && !arguments.allow_defects) {
    refuse(report, console);
    return kDefective;
  }

  write(report);
  report.stages.push_back({"write", watch.lap()});
  log_result(report, console);
  if (!arguments.common.json.empty()) write_json(arguments.common.json, to_json(report));
  if (arguments.check && !report.problems.empty()) return kCheckFailed;
  return result.error.unproven_faces > 0 || !kept_budget ? kNotConverged : kOk;
}

}  // namespace vmesh::tool
