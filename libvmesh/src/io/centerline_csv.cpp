#include <algorithm>
#include <optional>
#include <ostream>
#include <unordered_map>

#include "comments.h"
#include "formats.h"
#include "node_id.h"
#include "radius_array.h"
#include "text.h"

namespace vmesh {
namespace io {
namespace {

/// Rows of a CSV table whose header names the columns; '#' begins a comment. Columns are separated by commas, or by
/// semicolons or tabs if the header has more of them; numbers may then have a decimal comma.
class CsvTable {
 public:
  CsvTable(std::string_view content, std::string source) : lines_(content), source_(std::move(source)) {
    refuse_utf16(content, source_);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  /// `wanted`: the columns that there should be, for messages.
  void read_header(const std::string& wanted, LengthUnit& unit, Space& space) {
    wanted_ = "the header must name the columns " + wanted;
    std::string_view line;
    do {
      if (!lines_.next(line)) throw InvalidInput(source_ + ": it contains no table; " + wanted_);
      if (trim(line).starts_with('#')) read_tags(line, unit, space);
    } while (is_skipped(line));
    for (const char separator : {';', '\t'}) {
      if (std::count(line.begin(), line.end(), separator) > std::count(line.begin(), line.end(), separator_))
        separator_ = separator;
    }
    split(line);
    names_.reserve(fields_.size());
    for (const auto name : fields_) names_.push_back(lower(name));
  }

  /// The names of all columns, in lower case.
  const std::vector<std::string>& names() const { return names_; }

  /// Whether there is a column of that name, in any case; it becomes the next of those wanted.
  bool find(const std::string& name) {
    const auto found = std::ranges::find(names_, lower(name));
    if (found == names_.end()) return false;
    columns_.push_back(static_cast<std::size_t>(found - names_.begin()));
    return true;
  }

  void need(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (!find(name)) fail_without(name);
    }
  }

  [[noreturn]] void fail_without(const std::string& name, const std::string& hint = {}) const {
    fail("there is no column " + one_line(name) + "; " + wanted_ + hint);
  }

  bool next_row() {
    std::string_view line;
    do {
      if (!lines_.next(line)) return false;
      split(line);
    } while (is_skipped(line) || is_empty_row());
    if (fields_.size() != names_.size()) {
      fail("it has " + std::to_string(fields_.size()) + " columns, the header has " + std::to_string(names_.size()));
    }
    return true;
  }

  /// The field of the i-th wanted column.
  std::string_view field(std::size_t i) const { return fields_[columns_[i]]; }

  std::string id(std::size_t i) const {
    const auto value = parse_id(field(i));
    if (!value) fail(cite(field(i)) + " is not an id; ids are integers or names");
    return *value;
  }

  double real(std::size_t i) const {
    std::string text(field(i));
    const std::size_t comma = separator_ == ',' ? std::string::npos : text.find(',');
    if (comma != std::string::npos && text.find('.') == std::string::npos) text[comma] = '.';
    const auto value = parse_double(text);
    if (!value) fail(cite(field(i)) + " is not a number");
    return *value;
  }

  std::uint64_t line_number() const { return lines_.number(); }

 private:
  /// Where the first field of `line` ends. Within quotes, a separator is text.
  std::size_t field_end(std::string_view line) const {
    if (!trim(line).starts_with('"')) return line.find(separator_);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"') quoted = !quoted;
      if (line[i] == separator_ && !quoted) return i;
    }
    return std::string_view::npos;
  }

  static std::string_view unquoted(std::string_view field) {
    if (field.size() < 2 || !field.starts_with('"') || !field.ends_with('"')) return field;
    return trim(field.substr(1, field.size() - 2));
  }

  void split(std::string_view line) {
    fields_.clear();
    while (true) {
      const std::size_t end = field_end(line);
      fields_.push_back(unquoted(trim(line.substr(0, end))));
      if (end == std::string_view::npos) return;
      line.remove_prefix(end + 1);
    }
  }

  /// Spreadsheets end with such rows.
  bool is_empty_row() const {
    return std::all_of(fields_.begin(), fields_.end(), [](std::string_view field) { return field.empty(); });
  }

  static bool is_skipped(std::string_view line) {
    const auto text = trim(line);
    return text.empty() || text.front() == '#';
  }

  LineReader lines_;
  char separator_ = ',';
  std::string source_;
  std::string wanted_;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> columns_;
};

/// Finds the column of radii; nullopt if there need be none.
std::optional<RadiusArray> find_radius_column(CsvTable& table, const CenterlineReadOptions& options) {
  std::string name = options.radius_array.empty() ? "radius" : options.radius_array;
  if (table.find(name)) return RadiusArray(name);
  if (options.radius && options.radius_array.empty()) return std::nullopt;
  if (const auto area = only_area(table.names()); area && options.radius_array.empty()) {
    table.find(*area);
    return RadiusArray(*area);
  }
  table.fail_without(name,
                     "; name the one that holds the radius with --radius-array, or give one radius for all with "
                     "--radius");
}

}  // namespace

std::filesystem::path second_csv_file(const std::filesystem::path& path) {
  if (extension_of(path.stem()) == ".segments")
    throw InvalidInput(path.string() + ": this names the second file of a CSV pair; give the one with the nodes");
  return csv_segments_path(path);
}

RawCenterline parse_centerline_csv(std::string_view nodes, std::string_view segments, const std::string& source,
                                   const CenterlineReadOptions& options) {
  RawCenterline raw;
  raw.source = source;
  raw.node_word = "line";
  raw.segment_word = "line of the segments file";
  CsvTable table(nodes, source);
  table.read_header("id,x,y,z,radius", raw.unit, raw.space);
  table.need({"id", "x", "y", "z"});
  const std::optional<RadiusArray> radii = find_radius_column(table, options);
  if (radii) radii->note(raw);
  std::unordered_map<std::string, Index> index_of;
  while (table.next_row()) {
    const std::string id = table.id(0);
    if (!index_of.try_emplace(id, static_cast<Index>(raw.nodes.size())).second) {
      table.fail("the id " + shown_id(id) + " was given before; ids must be unique");
    }
    raw.nodes.push_back({{table.real(1), table.real(2), table.real(3)}, radii ? radii->radius(table.real(4)) : 0});
    raw.node_numbers.push_back(table.line_number());
  }
  if (trim(segments).empty()) return raw;
  CsvTable pairs(segments, csv_segments_path(source).string());
  pairs.read_header("a,b", raw.unit, raw.space);
  pairs.need({"a", "b"});
  while (pairs.next_row()) {
    const auto end = [&](std::size_t i) {
      const auto found = index_of.find(pairs.id(i));
      if (found == index_of.end())
        pairs.fail("there is no node with the id " + shown_id(pairs.id(i)) + " in " + source);
      return found->second;
    };
    const Index a = end(0);
    raw.segments.push_back({a, end(1)});
    raw.segment_numbers.push_back(pairs.line_number());
  }
  return raw;
}

void write_centerline_csv(std::ostream& nodes, std::ostream& segments, const Centerline& centerline,
                          const CenterlineMetadata& metadata) {
  nodes << comments(metadata, "# ") << "id,x,y,z,radius\n";
  std::string row;
  for (Index n = 0; n < centerline.nodes().size(); ++n) {
    const auto& [p, r] = centerline.node(n);
    row = std::to_string(n);
    for (const double x : {p.x(), p.y(), p.z(), r}) append(row += ',', x);
    nodes << row << "\n";
  }
  segments << "a,b\n";
  for (const auto& [a, b] : centerline.segments()) segments << std::to_string(a) << "," << std::to_string(b) << "\n";
}

}  // namespace io

std::filesystem::path csv_segments_path(const std::filesystem::path& nodes_path) {
  std::filesystem::path stem = nodes_path.stem();
  if (extension_of(stem) == ".nodes") stem = stem.stem();
  return std::filesystem::path(nodes_path).replace_filename(stem.string() + ".segments.csv");
}

}  // namespace vmesh
