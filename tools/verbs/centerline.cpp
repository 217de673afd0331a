#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/exact_text.h"
#include "report/extraction_report.h"
#include "report/summary.h"
#include "verbs/extraction.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

std::string describe(const CenterlineArguments& arguments) {
  return "centerline" + tool::describe(arguments.options) + tool::describe(arguments.image) +
         (arguments.each_label ? " --each-label" : "");
}

void check(const CenterlineArguments& arguments) {
  check_extraction(arguments.input, arguments.image, arguments.options);
  if (!arguments.each_label) return;
  if (!is_image(arguments.input.path)) throw UsageError("--each-label is for images; this is taken for a surface");
  if (arguments.image.threshold) throw UsageError("--each-label and --threshold exclude each other");
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

}  // namespace

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
  if (!arguments.common.json.empty())
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

}  // namespace vmesh::tool
