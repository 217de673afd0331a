#include "report/report_output.h"

#include "command_line/outputs.h"

namespace vmesh::tool {

void write_report(const std::vector<ReportTable>& tables, const Json& content, const ReportArguments& report,
                  const std::filesystem::path& json) {
  if (json != "-") write_text("-", format_report(tables, parse_report_format(report.format)));
  write_json(json, content);
  if (report.file.empty()) return;
  const std::string extension = extension_of(report.file);
  if (extension == ".json") return write_json(report.file, content);
  write_text(report.file, format_report(tables, parse_report_format(extension == ".md"    ? "markdown"
                                                                    : extension == ".csv" ? "csv"
                                                                                          : "text")));
}

}  // namespace vmesh::tool
