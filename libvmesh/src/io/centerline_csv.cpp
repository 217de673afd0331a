#include <algorithm>
#include <optional>
#include <ostream>
#include <unordered_map>

#include "comments.h"
#include "edge_radii.h"
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

  /// The columns of the first of these lists of which the table has the second column.
  void need_one_of(const std::vector<std::vector<std::string>>& lists) {
    const auto has = [this](const auto& list) { return std::ranges::find(names_, list[1]) != names_.end(); };
    const auto there = std::ranges::find_if(lists, has);
    for (const std::string& name : there == lists.end() ? lists.front() : *there) {
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

/// Reads the two tables, under our names of columns or Voreen's.
class CsvPairReader {
 public:
  CsvPairReader(std::string_view nodes, std::string_view segments, const std::string& source,
                const std::string& second_source, const CenterlineReadOptions& options)
      : options_(options),
        nodes_(nodes, source),
        has_segments_(!trim(segments).empty()),
        segments_(segments, second_source) {
    raw_.source = source;
    raw_.node_word = "line";
    raw_.segment_word = "line of the segments file";
  }

  RawCenterline run() {
    nodes_.read_header("id,x,y,z,radius", raw_.unit, raw_.space);
    nodes_.need_one_of({{"id", "x", "y", "z"}, {"id", "pos_x", "pos_y", "pos_z"}});
    if (has_segments_) {
      segments_.read_header("a,b", raw_.unit, raw_.space);
      segments_.need_one_of({{"a", "b"}, {"node1id", "node2id"}});
    }
    find_radius();
    read_nodes();
    if (has_segments_) read_segments();
    if (of_segments_) set_radii_of_segments(raw_, segment_radii_);
    return std::move(raw_);
  }

 private:
  /// In the table of nodes, or else in that of segments.
  void find_radius() {
    const std::string& wanted = options_.radius_array;
    const auto take = [&](CsvTable& table, const std::string& name) {
      if (!table.find(name)) return false;
      (&table == &nodes_ ? of_nodes_ : of_segments_).emplace(name).note(raw_);
      return true;
    };
    if (take(nodes_, wanted.empty() ? "radius" : wanted)) return;
    if (take(segments_, wanted.empty() ? "avgRadiusAvg" : wanted)) return;
    if (options_.radius && wanted.empty()) return;
    if (const auto area = only_area(nodes_.names()); area && wanted.empty()) {
      take(nodes_, *area);
      return;
    }
    nodes_.fail_without(wanted.empty() ? "radius" : wanted,
                        "; name the one that holds the radius with --radius-array, or give one radius for all with "
                        "--radius");
  }

  void read_nodes() {
    while (nodes_.next_row()) {
      const std::string id = nodes_.id(0);
      if (!index_of_.try_emplace(id, static_cast<Index>(raw_.nodes.size())).second)
        nodes_.fail("the id " + shown_id(id) + " was given before; ids must be unique");
      const double radius = of_nodes_ ? of_nodes_->radius(nodes_.real(4)) : 0;
      raw_.nodes.push_back({{nodes_.real(1), nodes_.real(2), nodes_.real(3)}, radius});
      raw_.node_numbers.push_back(nodes_.line_number());
    }
  }

  void read_segments() {
    while (segments_.next_row()) {
      const Index a = end(0);
      raw_.segments.push_back({a, end(1)});
      raw_.segment_numbers.push_back(segments_.line_number());
      if (of_segments_) segment_radii_.push_back(segment_radius());
    }
    if (unmeasured_ > 0)
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(unmeasured_) +
                              " segments have the radius -1, which stands for none");
  }

  double segment_radius() {
    const double value = segments_.real(2);
    constexpr double kUnmeasured = -1;  // by Voreen
    if (value == kUnmeasured) ++unmeasured_;
    if (!(value >= 0 || value == kUnmeasured))
      segments_.fail(cite(segments_.field(2)) + " is not a radius; it must be 0 or more");
    return of_segments_->radius(std::max(value, 0.0));
  }

  Index end(std::size_t column) const {
    const auto found = index_of_.find(segments_.id(column));
    if (found == index_of_.end())
      segments_.fail("there is no node with the id " + shown_id(segments_.id(column)) + " in " + raw_.source);
    return found->second;
  }

  const CenterlineReadOptions& options_;
  CsvTable nodes_;
  bool has_segments_;
  CsvTable segments_;
  RawCenterline raw_;
  std::optional<RadiusArray> of_nodes_, of_segments_;
  std::vector<double> segment_radii_;
  std::size_t unmeasured_ = 0;
  std::unordered_map<std::string, Index> index_of_;
};

}  // namespace

std::filesystem::path second_csv_file(const std::filesystem::path& path) {
  if (extension_of(path.stem()) == ".segments")
    throw InvalidInput(path.string() + ": this names the second file of a CSV pair; give the one with the nodes");
  return csv_segments_path(path);
}

std::filesystem::path voreens_second_file(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  const std::size_t at = name.rfind("nodes");
  if (at == std::string::npos) return {};
  return std::filesystem::path(path).replace_filename(name.replace(at, 5, "edges"));
}

RawCenterline parse_centerline_csv(std::string_view nodes, std::string_view segments, const std::string& source,
                                   const std::string& second_source, const CenterlineReadOptions& options) {
  return CsvPairReader(nodes, segments, source, second_source, options).run();
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
