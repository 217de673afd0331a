#include "report/report_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "command_line/outputs.h"

namespace vmesh::tool {
namespace {

bool is_number(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

// Where the decimal point is, or would be.
std::size_t point_of(const std::string& cell) { return std::min(cell.find('.'), cell.size()); }

// How a column is laid out: numbers with their decimal points below each other, text from the left.
struct Column {
  bool numbers = false;
  std::size_t width = 3;              // Markdown's rule needs three dashes
  std::size_t before = 0, after = 0;  // characters before the decimal point, and from it on
};

Column column_of(const ReportTable& table, std::size_t c) {
  Column column;
  bool others = false;
  column.width = std::max(column.width, table.columns[c].size());
  for (const auto& row : table.rows) {
    const std::string& cell = row[c];
    column.width = std::max(column.width, cell.size());
    column.before = std::max(column.before, point_of(cell));
    column.after = std::max(column.after, cell.size() - point_of(cell));
    column.numbers |= is_number(cell);
    others |= !is_number(cell) && cell != "-" && !cell.empty();
  }
  column.numbers &= !others;
  if (column.numbers) column.width = std::max(column.width, column.before + column.after);
  return column;
}

std::vector<Column> columns_of(const ReportTable& table) {
  std::vector<Column> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) columns.push_back(column_of(table, c));
  return columns;
}

std::string blanks(std::size_t width, std::size_t taken) { return std::string(width - std::min(width, taken), ' '); }

std::string heading(const std::string& text, const Column& column) {
  return column.numbers ? blanks(column.width, text.size()) + text : text + blanks(column.width, text.size());
}

std::string padded(const std::string& cell, const Column& column) {
  if (!column.numbers) return cell + blanks(column.width, cell.size());
  const std::string right = blanks(column.after, cell.size() - point_of(cell));
  return blanks(column.width, cell.size() + right.size()) + cell + right;
}

using Pad = std::string (*)(const std::string&, const Column&);

std::string text_line(const std::vector<std::string>& cells, const std::vector<Column>& columns, Pad pad) {
  std::string line;
  for (std::size_t c = 0; c < cells.size(); ++c) line += "  " + pad(cells[c], columns[c]);
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
}

std::string text_table(const ReportTable& table) {
  const auto columns = columns_of(table);
  std::string text = table.title + "\n" + text_line(table.columns, columns, heading);
  for (const auto& row : table.rows) text += text_line(row, columns, padded);
  return text;
}

std::string markdown_line(std::vector<std::string> cells, const std::vector<Column>& columns, Pad pad) {
  std::string line = "|";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (std::size_t at = 0; (at = cells[c].find('|', at)) != std::string::npos; at += 2) cells[c].insert(at, "\\");
    line += " " + pad(cells[c], columns[c]) + " |";
  }
  return line + "\n";
}

std::string markdown_table(const ReportTable& table) {
  const auto columns = columns_of(table);
  std::string text = "## " + table.title + "\n\n" + markdown_line(table.columns, columns, heading) + "|";
  for (const Column& column : columns) text += std::string(column.width + 1, '-') + (column.numbers ? ":|" : "-|");
  text += "\n";
  for (const auto& row : table.rows) text += markdown_line(row, columns, padded);
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

std::string format_briefly(double value) {
  constexpr int kDigits = 3;
  if (value == 0 || !std::isfinite(value)) return formatted("%g", value);
  const int decimals = kDigits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  return formatted("%.*f", std::clamp(decimals, 0, 9), value);
}

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
