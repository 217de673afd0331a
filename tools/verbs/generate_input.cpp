#include "verbs/generate_input.h"

#include <algorithm>
#include <cmath>

#include "vmesh/centerline/round_ends.h"

#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/summary.h"
#include "verbs/extraction.h"
#include "verbs/fitting.h"

namespace vmesh::tool {
namespace {

/// Whether --label and the like apply to the input.
bool has_image(const GenerateArguments& arguments) { return is_image(arguments.input.path); }

LoadedCenterline load(const InputArguments& input, Console& console) {
  LoadedCenterline loaded = load_clean_centerline(input, console);
  const Centerline& centerline = loaded.cleaned.centerline;
  console.log(std::to_string(centerline.nodes().size()) + " nodes, " + std::to_string(centerline.segments().size()) +
              " segments, " + std::to_string(centerline.component_count()) + " components, " +
              std::to_string(centerline.cycle_rank()) + " loops");
  return loaded;
}

/// Draws ends back that are to be round (see with_round_ends()), so that --centerline-output is what the surface is
/// grown around and refers to. Those ends have no section then.
void round_ends(const GenerateArguments& arguments, ExtractedCenterline& extracted) {
  const OpenEnds& open = arguments.production.growth.open_ends;
  if (arguments.production.ends != EndShape::round || open.all) return;
  std::vector<EndSection> round;
  std::erase_if(extracted.end_sections, [&](const EndSection& section) {
    if (std::find(open.nodes.begin(), open.nodes.end(), section.node) != open.nodes.end()) return false;
    round.push_back(section);
    return true;
  });
  extracted.centerline = with_round_ends(extracted.centerline, round);
}

/// The centerline of a segmentation, and its surface, to which the grown one is fitted.
GenerateInput extract_input(const GenerateArguments& arguments, std::optional<TriMesh> reference, Console& console) {
  GenerateInput input;
  ExtractedCenterline extracted =
      extract(arguments.input, arguments.fitting.image, arguments.extraction, input.stages, console);
  round_ends(arguments, extracted);
  const Centerline& centerline = extracted.centerline;
  if (!arguments.centerline_output.empty())
    write_centerline(arguments.centerline_output, centerline,
                     {generator_name(), "extracted by generate", arguments.input.path.filename().string(),
                      sha256_of_input(arguments.input.path), arguments.writing.unit, arguments.writing.space},
                     extracted.end_sections, console);
  stop_if_interrupted();
  if (!reference) {
    FittingArguments own = arguments.fitting;
    own.reference = arguments.input;
    StageClock contour;
    reference = load_fit_reference(own, console);
    contour.lap("contour", input.stages);
  }
  input.reference = std::move(reference);
  input.centerline.cleaned.centerline = centerline;
  input.centerline.cleaned.end_sections = extracted.end_sections;
  for (Index n = 0; n < centerline.nodes().size(); ++n) input.centerline.cleaned.raw_node.push_back(n);
  for (Index s = 0; s < centerline.segments().size(); ++s) input.centerline.cleaned.raw_segment.push_back(s);
  input.extraction = std::move(extracted.report);
  return input;
}

}  // namespace

void check_input(const GenerateArguments& arguments) {
  const ReferenceOptions& image = arguments.fitting.image;
  const bool fits = !arguments.fitting.reference.path.empty();
  if (has_image(arguments)) {
    if (arguments.extraction.balanced_wall)
      throw UsageError(arguments.input.path.string() + ": --balanced-wall is for surfaces; this is taken for an image");
    if (!arguments.input.more.empty())
      throw UsageError(arguments.input.more.front().string() + ": an image must be the only input");
    if (fits && has_options(image) && is_image(arguments.fitting.reference.path))
      throw UsageError(
          "--label, --threshold, --spacing and --smooth would apply to two images; extract the centerline "
          "first (vmesh centerline), or omit --fit: the surface is then fitted to its own image");
    return;
  }
  if (arguments.segmentation) {
    if (!fits && has_options(image))
      throw UsageError("--label, --threshold, --spacing and --smooth are for images; none is given");
    return;
  }
  if (!arguments.centerline_output.empty())
    throw UsageError("--centerline-output is for an image or a wall as input; this is taken for a centerline");
  const ExtractOptions plain;
  const RequiredCoverage& required = arguments.required_coverage;
  if (arguments.extraction.tree || arguments.extraction.balanced_wall ||
      arguments.extraction.spacing != plain.spacing || arguments.extraction.join != plain.join ||
      arguments.extraction.largest || arguments.extraction.least_length > 0 || required.wall > 0 || required.length > 0)
    throw UsageError(
        "--step, --join, --largest, --least-length, --tree, --balanced-wall and --require are for an image or a wall "
        "as "
        "input; this is taken for a centerline");
  if (fits) return;
  if (arguments.fitting.options.error > 0 || arguments.fitting.options.max_error > 0)
    throw UsageError("--fit-error needs --fit REFERENCE");
  if (has_options(image))
    throw UsageError("--label, --threshold, --spacing and --smooth are for images; none is given");
}

void apply_budget_to_fit(GenerateArguments& arguments) {
  FittingArguments& fitting = arguments.fitting;
  if (fit_reference(arguments).empty()) return;
  if (arguments.production.growth.max_error.is_set())
    throw UsageError("--max-error is a limit on the distance to round cones; with --fit see --fit-error");
  fitting.options.threads = arguments.production.growth.threads;
  if (!arguments.budget) return;
  set_budget(*arguments.budget, fitting.options);
  // A budget of vertices applies to growth as well.
  if (arguments.budget->kind == Budget::Kind::error) arguments.budget.reset();
}

std::filesystem::path fit_reference(const GenerateArguments& arguments) {
  const std::filesystem::path& path = arguments.fitting.reference.path;
  return path.empty() && arguments.segmentation ? arguments.input.path : path;
}

GenerateInput load_input(const GenerateArguments& arguments, Console& console) {
  std::optional<TriMesh> reference;
  if (!arguments.fitting.reference.path.empty()) {
    FittingArguments fitting = arguments.fitting;
    if (has_image(arguments) && !is_image(fitting.reference.path)) fitting.image = {};  // they are the input's
    reference = load_fit_reference(fitting, console);
  }
  GenerateInput input;
  if (arguments.segmentation) {
    input = extract_input(arguments, std::move(reference), console);
  } else {
    StageClock clock;
    input.centerline = load(arguments.input, console);
    clock.lap("read", input.stages);
    input.reference = std::move(reference);
  }
  return input;
}

}  // namespace vmesh::tool
