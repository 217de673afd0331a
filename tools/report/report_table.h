#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::tool {

/// A titled table of a report. Every row has as many cells as there are columns; the first one names it.
struct ReportTable {
  std::string key;  ///< stands for the title in CSV
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

enum class ReportFormat { text, markdown, csv };

/// "text", "markdown" or "csv".
ReportFormat parse_report_format(std::string_view name);

/// Text and Markdown: tables with aligned columns. CSV: one line `table,row,column,value` per cell, so that every
/// number has its name beside it.
std::string format_report(const std::vector<ReportTable>& tables, ReportFormat format);

/// A number with six significant digits.
std::string format_number(double value);

std::string format_point(const Vec3& p);

/// The same for a bound, rounded so that it remains one.
std::string format_lower_bound(double value);
std::string format_upper_bound(double value);

}  // namespace vmesh::tool
