#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/outputs.h"
#include "report/extraction_report.h"
#include "report/summary.h"
#include "verbs/extraction.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

std::string describe(const CenterlineArguments& arguments) {
  return "centerline" + tool::describe(arguments.options) + tool::describe(arguments.image);
}

}  // namespace

int run(const CenterlineArguments& arguments, Console& console) {
  using Kind = PlannedOutput::Kind;
  const std::filesystem::path& path = arguments.input.path;
  check_extraction(arguments.input, arguments.image);
  std::vector<PlannedOutput> outputs = {{arguments.common.json, Kind::summary}};
  for (const std::filesystem::path& file : files_of(arguments.output)) outputs.push_back({file, Kind::centerline});
  check_outputs(outputs, files_of_input(path));
  const ExtractedCenterline result = extract(arguments.input, arguments.image, arguments.options, console);
  stop_if_interrupted();
  const std::string sha256 = sha256_of_input(path);
  write_centerline(arguments.output, result.centerline,
                   {generator_name(), describe(arguments), path.filename().string(), sha256}, result.end_sections,
                   console);
  console.log("wrote " + arguments.output.string());
  if (!arguments.common.json.empty())
    write_json(arguments.common.json, {{"schema", "vmesh.extraction/2"},
                                       {"generator", generator_json()},
                                       {"input", {{"file", path.string()}, {"sha256", sha256}}},
                                       {"options", describe(arguments)},
                                       {"centerline", to_json(result.centerline)},
                                       {"end_sections", to_json(result.end_sections)},
                                       {"extraction", to_json(result.report)}});
  return kOk;
}

}  // namespace vmesh::tool
