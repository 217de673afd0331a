#include <sstream>

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "command_line/usage_error.h"
#include "report/summary.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

void check(const CenterlineArguments& arguments) {
  const ReferenceOptions& image = arguments.image;
  if (is_image(arguments.input.path)) return;
  if (image.label || image.threshold || image.spacing > 0 || image.smooth > 0)
    throw UsageError(arguments.input.path.string() +
                     ": --label, --threshold, --spacing and --smooth are for images; this is taken for a surface");
}

std::string describe(const CenterlineArguments& arguments) {
  std::ostringstream text;
  text << "centerline --step " << arguments.options.spacing << " --join " << arguments.options.join;
  if (arguments.image.label) text << " --label " << *arguments.image.label;
  if (arguments.image.threshold) text << " --threshold " << *arguments.image.threshold;
  if (arguments.image.spacing > 0) text << " --spacing " << arguments.image.spacing;
  if (arguments.image.smooth > 0) text << " --smooth " << arguments.image.smooth;
  if (arguments.options.all_components) text << " --all-components";
  if (arguments.options.tree) text << " --tree";
  return text.str();
}

TriMesh surface_of(const CenterlineArguments& arguments, Console& console) {
  if (is_image(arguments.input.path)) {
    ReferenceOptions options = arguments.image;
    options.all_components = true;  // extraction decides which components belong together
    return reference_surface(load_image(arguments.input, console), options).mesh;
  }
  LoadedSurface surface = load_surface(arguments.input);
  console.warn(surface.warnings);
  return std::move(surface.mesh);
}

ExtractedCenterline extracted(const CenterlineArguments& arguments, Console& console) {
  return naming(arguments.input.path, [&] {
    const TriMesh surface = surface_of(arguments, console);
    stop_if_interrupted();
    return extract_centerline(surface, arguments.options, console.progress());
  });
}

void log(const ExtractedCenterline& result, Console& console) {
  const Centerline& centerline = result.centerline;
  const ExtractionReport& report = result.report;
  std::ostringstream text;
  text.precision(3);
  text << centerline.nodes().size() << " nodes, " << centerline.component_count() << " components, "
       << centerline.cycle_rank() << " loops; surface to the vessels' boundary " << report.coverage.mean << " mm mean, "
       << report.coverage.percentile_95 << " at 95 %, " << report.coverage.max << " max at ("
       << report.coverage.max_at.x() << ", " << report.coverage.max_at.y() << ", " << report.coverage.max_at.z() << ')';
  console.log(text.str());
  if (report.left_out > 0)
    console.warn(std::to_string(report.left_out) + " of " + std::to_string(report.parts) +
                 " parts of the surface are apart from the rest and were left out; --join joins over wider gaps, "
                 "--all-components keeps them apart");
}

}  // namespace

int run(const CenterlineArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check(arguments);
  std::vector<PlannedOutput> outputs = {{arguments.common.json, Kind::summary}};
  for (const std::filesystem::path& file : files_of(arguments.output)) outputs.push_back({file, Kind::centerline});
  check_outputs(outputs, files_of_input(path));
  const ExtractedCenterline result = extracted(arguments, console);
  stop_if_interrupted();
  log(result, console);
  const std::string sha256 = sha256_of_input(path);
  write_centerline(arguments.output, result.centerline,
                   {generator_name(), describe(arguments), path.filename().string(), sha256});
  console.log("wrote " + arguments.output.string());
  if (!arguments.common.json.empty())
    write_json(arguments.common.json, {{"schema", "vmesh.extraction/1"},
                                       {"generator", generator_json()},
                                       {"input", {{"file", path.string()}, {"sha256", sha256}}},
                                       {"options", describe(arguments)},
                                       {"centerline", to_json(result.centerline)},
                                       {"extraction", to_json(result.report)}});
  return kOk;
}

}  // namespace vmesh::tool
