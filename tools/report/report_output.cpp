#include "report/report_output.h"

#include "command_line/outputs.h"

namespace vmesh::tool {

void write_report(const std::vector<ReportTable>& tables, const Json& json, const ReportOutputs& outputs) {
  if (outputs.json != "-") write_text("-", format_report(tables, parse_report_format(outputs.format)));
  if (!outputs.json.empty()) write_json(outputs.json, json);
  if (outputs.file.empty()) return;
  const std::string extension = extension_of(outputs.file);
  if (extension == ".json") return write_json(outputs.file, json);
  write_text(outputs.file, format_report(tables, parse_report_format(extension == ".md"    ? "markdown"
                                                                     : extension == ".csv" ? "csv"
                                                                                           : "text")));
}

}  // namespace vmesh::tool
