#include "report/report_table.h"

#include <algorithm>
#include <cmath>

#include "command_line/outputs.h"

namespace vmesh::tool {
namespace {

std::vector<std::size_t> column_widths(const ReportTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = std::max<std::size_t>(table.columns[c].size(), 3);  // Markdown's rule needs three dashes
    for (const auto& row : table.rows) width = std::max(width, row[c].size());
    widths.push_back(width);
  }
  return widths;
}

std::string padded(const std::string& cell, std::size_t width) {
  return cell + std::string(width - std::min(width, cell.size()), ' ');
}

std::string text_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) line += "  " + padded(cells[c], widths[c]);
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

std::string text_table(const ReportTable& table) {
  const auto widths = column_widths(table);
  std::string text = table.title + "\n" + text_line(table.columns, widths);
  for (const auto& row : table.rows) text += text_line(row, widths);
  return text;
}

std::string markdown_line(std::vector<std::string> cells, const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t at = 0; (at = cells[c].find('|', at)) != std::string::npos; at += 2) cells[c].insert(at, "\\");
    line += " " + padded(cells[c], widths[c]) + " |";
  }
  return line + "\n";
}

std::string markdown_table(const ReportTable& table) {
  const auto widths = column_widths(table);
  std::string text = "## " + table.title + "\n\n" + markdown_line(table.columns, widths) + "|";
  for (const std::size_t width : widths) text += std::string(width + 2, '-') + "|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_line(row, widths);
  return text;
}

std::string csv_cell(const std::string& cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_lines(const ReportTable& table) {
  std::string text;
  for (const auto& row : table.rows) {
    for (std::size_t c = 1; c < row.size(); ++c) {
      text += csv_cell(table.key) + "," + csv_cell(row[0]) + "," + csv_cell(table.columns[c]) + "," + csv_cell(row[c]) +
              "\n";
    }
  }
  return text;
}

// One unit of the last digit that format_number() shows.
double last_digit(double value) { return value == 0 ? 0 : std::pow(10, std::floor(std::log10(std::abs(value))) - 5); }

// Text and Markdown: tables with aligned columns. CSV: one line `table,row,column,value` per cell, so that every number
// has its name beside it.
std::string format_report(const std::vector<ReportTable>& tables, std::string_view format) {
  std::string text = format == "csv" ? "table,row,column,value\n" : "";
  for (const ReportTable& table : tables) {
    if (format != "csv" && !text.empty()) text += "\n";
    text += format == "csv" ? csv_lines(table) : format == "markdown" ? markdown_table(table) : text_table(table);
  }
  return text;
}

}  // namespace

std::string yes_no(bool value) { return value ? "yes" : "no"; }

std::string format_number(double value) { return formatted("%.6g", value); }

std::string format_point(const Vec3& p) {
  return "(" + format_number(p.x()) + ", " + format_number(p.y()) + ", " + format_number(p.z()) + ")";
}

std::string format_lower_bound(double value) {
  const std::string text = format_number(value);
  return std::stod(text) <= value ? text : format_number(value - last_digit(value));
}

std::string format_upper_bound(double value) {
  const std::string text = format_number(value);
  return std::stod(text) >= value ? text : format_number(value + last_digit(value));
}

void write_report(const std::vector<ReportTable>& tables, const Json& content, const ReportArguments& report,
                  const std::filesystem::path& json) {
  if (json != "-") write_text("-", format_report(tables, report.format));
  write_json(json, content);
  if (report.file.empty()) return;
  const std::string extension = extension_of(report.file);
  if (extension == ".json") return write_json(report.file, content);
  write_text(report.file, format_report(tables, extension == ".md"    ? "markdown"
                                                : extension == ".csv" ? "csv"
                                                                      : "text"));
}

}  // namespace vmesh::tool
