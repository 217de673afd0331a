#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/report_table.h"
#include "report/summary.h"

namespace vmesh::tool {

/// The outputs of a report.
struct ReportOutputs {
  std::string format;          ///< of stdout: text, markdown or csv
  std::filesystem::path json;  ///< "-": stdout gets JSON instead; empty: none
  std::filesystem::path file;  ///< by its extension .txt, .md, .csv or .json; empty: none
};

void write_report(const std::vector<ReportTable>& tables, const Json& json, const ReportOutputs& outputs);

}  // namespace vmesh::tool
