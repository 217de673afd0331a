#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/text.h"
#include "vmesh/core/types.h"

#include "command_line/arguments.h"
#include "report/json.h"

namespace vmesh::tool {

/// A titled table of a report. Every row has as many cells as there are columns; the first one names it.
struct ReportTable {
  std::string key;  ///< stands for the title in CSV
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

std::string yes_no(bool value);

/// Writes the tables to stdout and to the report's file, the content to `json` unless empty; "-": stdout gets the JSON.
void write_report(const std::vector<ReportTable>& tables, const Json& content, const ReportArguments& report,
                  const std::filesystem::path& json);

/// A number with six significant digits.
std::string format_number(double value);

/// With three, and all digits before the decimal point.
std::string format_briefly(double value);

std::string format_point(const Vec3& p);

/// The same for a bound, rounded so that it remains one.
std::string format_lower_bound(double value);
std::string format_upper_bound(double value);

}  // namespace vmesh::tool
