#include "command_line/arguments_segmentation.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/verb.h"
#include "report/exact_text.h"
#include "report/extraction_report.h"
#include "report/summary.h"
#include "verbs/extraction.h"

namespace vmesh::tool::centerline_verb {
namespace {

struct CenterlineArguments {
  CommonArguments common;
  InputArguments input;
  std::filesystem::path output;
  ExtractOptions options;
  ReferenceOptions image;   ///< which voxels of an image are inside
  bool each_label = false;  ///< a centerline of each label on its own
  RequiredCoverage required_coverage;
};

void add_options(CLI::App& verb, CenterlineArguments& arguments) {
  add_input(verb, arguments.input, "surface, or image (" + listed_image_extensions() + ")");
  add_voxel_size(verb, arguments.input, "");
  add_output(verb, arguments.output, kCenterlineFile, "centerline");
  add_image_options(verb, arguments.image);
  verb.add_flag("--each-label", arguments.each_label,
                "image: a centerline of each label on its own, in one file; segments carry the label (.json, .vtp)");
  add_extraction(verb, arguments.options);
  add_required_coverage(verb, arguments.required_coverage);
  group(verb, "What of an image is inside", {"--label", "--each-label", "--threshold", "--spacing", "--smooth"});
}

std::string describe(const CenterlineArguments& arguments) {
  return "centerline" + tool::describe(arguments.options) + tool::describe(arguments.image) +
         (arguments.each_label ? " --each-label" : "");
}

void check(const CenterlineArguments& arguments) {
  check_extraction(arguments.input, arguments.image, arguments.options);
  if (!arguments.each_label) return;
  if (!is_image(arguments.input.path)) throw UsageError("--each-label is for images; this is taken for a surface");
  if (arguments.image.threshold) throw UsageError("--each-label and --threshold exclude each other");
  if (!arguments.image.segments.empty()) throw UsageError("--each-label takes labels by their values, not by name");
}

/// Those given, else all in the image.
std::vector<double> labels_of(const CenterlineArguments& arguments, Console& console) {
  if (!arguments.image.labels.empty()) return arguments.image.labels;
  const ImageSummary summary = load_image_summary(arguments.input, console);
  std::vector<double> labels;
  for (const ImageLabel& label : summary.labels) labels.push_back(label.value);
  if (labels.empty())
    throw InvalidInput(arguments.input.path.string() + ": it holds no labels; give --threshold for grey values");
  return labels;
}

/// The centerline of all labels together, or of each, in one graph.
struct Result {
  std::vector<CenterlineNode> nodes;
  std::vector<CenterlineSegment> segments;
  std::vector<double> labels;  // of the segments, with --each-label
  std::vector<EndSection> sections;
  Json extraction;  // a report, or with --each-label a list of them
  std::vector<StageTime> stages;
  bool covered = true;
};

void append(ExtractedCenterline&& extracted, Result& result) {
  const auto first = static_cast<Index>(result.nodes.size());
  const Centerline& centerline = extracted.centerline;
  result.nodes.insert(result.nodes.end(), centerline.nodes().begin(), centerline.nodes().end());
  for (const CenterlineSegment& s : centerline.segments()) result.segments.push_back({s.a + first, s.b + first});
  for (EndSection& section : extracted.end_sections) {
    section.node += first;
    result.sections.push_back(std::move(section));
  }
}

Result extract_all(const CenterlineArguments& arguments, Console& console) {
  Result result;
  ExtractedCenterline extracted = extract(arguments.input, arguments.image, arguments.options, result.stages, console);
  result.covered = meets(arguments.required_coverage, extracted.report, console);
  result.extraction = to_json(extracted.report);
  append(std::move(extracted), result);
  return result;
}

Result extract_each_label(const CenterlineArguments& arguments, Console& console) {
  Result result;
  result.extraction = Json::array();
  for (const double label : labels_of(arguments, console)) {
    stop_if_interrupted();
    console.log("label " + exact_text(label) + ":");
    ReferenceOptions image = arguments.image;
    image.labels = {label};
    ExtractedCenterline extracted = extract(arguments.input, image, arguments.options, result.stages, console);
    result.covered &= meets(arguments.required_coverage, extracted.report, console);
    result.extraction.push_back(to_json(extracted.report));
    result.extraction.back()["label"] = label;
    append(std::move(extracted), result);
    result.labels.resize(result.segments.size(), label);
  }
  return result;
}

int run(const CenterlineArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check(arguments);
  std::vector<PlannedOutput> outputs = {{arguments.common.json, Kind::summary}};
  for (const std::filesystem::path& file : files_of(arguments.output)) outputs.push_back({file, Kind::centerline});
  check_outputs(outputs, files_of_input(path));
  const Result result = arguments.each_label ? extract_each_label(arguments, console) : extract_all(arguments, console);
  const Centerline centerline(result.nodes, result.segments);
  stop_if_interrupted();
  CenterlineMetadata metadata = {generator_name(), describe(arguments), path.filename().string(),
                                 sha256_of_input(path)};
  metadata.segment_labels = result.labels;
  write_centerline(arguments.output, centerline, metadata, result.sections, console);
  console.log("wrote " + arguments.output.string());
  write_json(arguments.common.json, {{"schema", "vmesh.extraction/2"},
                                     {"generator", generator_json()},
                                     {"input", {{"file", path.string()}, {"sha256", metadata.input_sha256}}},
                                     {"options", describe(arguments)},
                                     {"centerline", to_json(centerline)},
                                     {"end_sections", to_json(result.sections)},
                                     {"extraction", result.extraction},
                                     {"seconds", stages_json(result.stages)}});
  return result.covered ? kOk : kCheckFailed;
}

const VerbRegistration<CenterlineArguments> kRegistration({
    .rank = 90,
    .name = "centerline",
    .help = "Extract the centerline with radii from a surface, open or closed, or an image",
    .examples = R"(Examples:
  vmesh centerline portal.ply -o portal.json
  vmesh centerline liver.nii.gz --label 2 -o portal.swc --tree
  vmesh centerline aorta-open.stl --unit mm -o aorta.vtp --require coverage=.98
  vmesh centerline circle.nii.gz --each-label -o circle.json)",
    .add_options = add_options,
    .settle = settle_output,
    .run = run,
});

}  // namespace
}  // namespace vmesh::tool::centerline_verb
