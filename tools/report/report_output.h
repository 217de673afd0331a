#pragma once

#include <filesystem>
#include <vector>

#include "command_line/arguments.h"
#include "report/report_table.h"
#include "report/summary.h"

namespace vmesh::tool {

/// Writes to stdout, to the report's file, and to `json` unless empty; "-": stdout gets JSON instead.
void write_report(const std::vector<ReportTable>& tables, const Json& content, const ReportArguments& report,
                  const std::filesystem::path& json);

}  // namespace vmesh::tool
