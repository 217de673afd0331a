#include <algorithm>
#include <map>

#include "formats.h"
#include "poly_lines.h"
#include "text.h"

namespace vmesh::io {
namespace {

/// Reads the text variant of the format (VTK File Formats, "Simple Legacy Formats") up to version 5.1. After four lines
/// of header it is a stream of words.
class LegacyVtkReader {
 public:
  LegacyVtkReader(std::string_view content, const std::string& source, const std::string& radius_array)
      : lines_(content), source_(source), radius_array_(radius_array) {}

  RawCenterline run() {
    read_header();
    for (std::string keyword; next_word(keyword);) read_block(keyword);
    set_radii();
    RawCenterline raw = to_raw_centerline(data_, source_);
    raw.unit = unit_;
    raw.space = space_;
    return raw;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  std::string_view header_line(const char* wanted) {
    std::string_view line;
    if (!lines_.next(line)) fail(std::string("the file ends where ") + wanted + " should be");
    return trim(line);
  }

  void read_header() {
    if (!header_line("the header").starts_with("# vtk DataFile Version")) {
      fail("this is no legacy VTK file: it does not begin with \"# vtk DataFile Version\"");
    }
    read_tags(header_line("the title"), unit_, space_);  // 3D Slicer puts SPACE=... there
    const std::string format = lower(header_line("the word ASCII"));
    if (format == "binary") {
      throw Unsupported(source_ + ": binary legacy VTK is not supported; save it as .vtp, or as .vtk in text (ASCII)");
    }
    if (format != "ascii") fail("the word ASCII should be here, not " + cite(format));
    if (const std::string keyword = lower(word()); keyword != "dataset")
      fail(cite(keyword) + " stands where DATASET should");
    const std::string kind(word());
    if (lower(kind) != "polydata") {
      throw Unsupported(source_ + ": this is a data set of the kind " + cite(kind) + "; a centerline is POLYDATA");
    }
  }

  /// The next word of the file, in lower case; false at its end.
  bool next_word(std::string& keyword) {
    if (!skip_to_word()) return false;
    keyword = lower(fields_[field_++]);
    return true;
  }

  bool skip_to_word() {
    std::string_view line;
    while (field_ == fields_.size()) {
      if (!lines_.next(line)) return false;
      split_blank(line, fields_);
      field_ = 0;
    }
    return true;
  }

  std::string_view word() {
    if (!skip_to_word()) fail("the file ends too early; it is cut off, get the whole file");
    return fields_[field_++];
  }

  bool next_is(std::string_view keyword) { return skip_to_word() && lower(fields_[field_]) == keyword; }

  double number() {
    const std::string_view text = word();
    const auto value = parse_double(text);
    if (!value) fail(cite(text) + " is no number");
    return *value;
  }

  std::int64_t integer() {
    const std::string_view text = word();
    const auto value = parse_integer(text);
    if (!value) fail(cite(text) + " is no whole number");
    return *value;
  }

  /// How many of something that takes at least a character and a blank each are to come.
  std::size_t count(std::size_t numbers_each = 1) {
    const std::int64_t value = integer();
    if (value < 0) fail("the count " + std::to_string(value) + " is negative");
    const std::size_t most = lines_.rest().size() / 2 + 1;
    if (static_cast<std::size_t>(value) > most || static_cast<std::size_t>(value) * numbers_each > most) {
      fail("the count " + std::to_string(value) + " is more than the file can hold");
    }
    return static_cast<std::size_t>(value);
  }

  void read_block(const std::string& keyword) {
    if (keyword == "points") return read_points();
    if (keyword == "lines") return read_cells(data_.lines);
    if (keyword == "vertices") return read_cells(data_.vertices);
    if (keyword == "polygons" || keyword == "triangle_strips") return skip_cells();
    if (keyword == "point_data" || keyword == "cell_data") return begin_attributes(keyword == "point_data");
    if (keyword == "field") return read_field();
    if (keyword == "scalars") return read_scalars();
    if (keyword == "metadata") return skip_metadata();
    skip_attribute(keyword);
  }

  void read_points() {
    if (!data_.points.empty()) fail("the points were there before");
    const std::size_t size = count(3);
    word();  // their type
    for (std::size_t i = 0; i < size; ++i) {
      const double x = number(), y = number();
      data_.points.push_back({{x, y, number()}, 0});
    }
  }

  void read_cells(std::vector<std::vector<Index>>& cells) {
    if (!cells.empty()) fail("cells of this kind were there before");
    const std::size_t rows = count(), size = count();
    next_is("offsets") ? read_offset_cells(cells, rows, size) : read_counted_cells(cells, rows, size);
  }

  /// Up to version 4: every cell is its number of points and the points; `size` counts all these numbers.
  void read_counted_cells(std::vector<std::vector<Index>>& cells, std::size_t rows, std::size_t size) {
    std::size_t read = 0;
    for (std::size_t c = 0; c < rows; ++c) {
      const std::size_t points = count();
      read += 1 + points;
      if (read > size) break;
      auto& cell = cells.emplace_back();
      for (std::size_t i = 0; i < points; ++i) cell.push_back(point_index());
    }
    if (read != size) fail("the cells do not have the " + std::to_string(size) + " numbers that are announced");
  }

  /// From version 5: where every cell begins, and the end, in a list of points.
  void read_offset_cells(std::vector<std::vector<Index>>& cells, std::size_t rows, std::size_t size) {
    read_array_head("offsets");
    std::vector<std::size_t> offsets;
    for (std::size_t i = 0; i < rows; ++i) {
      const std::int64_t offset = integer();
      const std::size_t least = offsets.empty() ? 0 : offsets.back();
      if (offset < static_cast<std::int64_t>(least) || offset > static_cast<std::int64_t>(size)) {
        fail("the offset " + std::to_string(offset) + " is out of range; it must be from " + std::to_string(least) +
             " to " + std::to_string(size));
      }
      offsets.push_back(static_cast<std::size_t>(offset));
    }
    read_array_head("connectivity");
    std::vector<Index> points;
    for (std::size_t i = 0; i < size; ++i) points.push_back(point_index());
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      cells.emplace_back(points.data() + offsets[c], points.data() + offsets[c + 1]);
    }
  }

  void read_array_head(std::string_view name) {
    if (!next_is(name)) fail("the word " + std::string(name) + " should follow");
    word();
    word();  // the type
  }

  Index point_index() {
    const std::int64_t index = integer();
    if (index < 0 || index >= static_cast<std::int64_t>(data_.points.size())) {
      fail("there is no point " + std::to_string(index) + "; there are " + std::to_string(data_.points.size()) +
           " before this line, the first is 0");
    }
    return static_cast<Index>(index);
  }

  void skip_cells() {
    std::vector<std::vector<Index>> cells;
    read_cells(cells);
  }

  void begin_attributes(bool of_points) {
    tuples_ = count();
    of_points_ = of_points;
    if (of_points && tuples_ != data_.points.size()) {
      fail("there must be data for every one of the " + std::to_string(data_.points.size()) + " points");
    }
  }

  void read_field() {
    word();  // the name of the field
    const std::size_t arrays = count();
    for (std::size_t a = 0; a < arrays; ++a) {
      const std::string name = field_array_name();
      const std::size_t components = count(), tuples = count(components);
      const std::string type = lower(word());
      if (type == "string" || type == "utf8_string" || type == "variant") {
        read_texts(name, components * tuples);
      } else {
        read_numbers(name, components, tuples);
      }
    }
  }

  std::string field_array_name() {
    while (next_is("metadata")) {
      word();
      skip_metadata();
    }
    return std::string(word());
  }

  void read_texts(const std::string& name, std::size_t lines) {
    std::string_view line;
    for (std::size_t i = 0; i < lines; ++i) {
      if (!lines_.next(line)) fail("the file ends too early; it is cut off, get the whole file");
      if (i == 0) read_tags(name + "=" + std::string(trim(line)), unit_, space_);
    }
    fields_.clear();
    field_ = 0;
  }

  void read_scalars() {
    const std::string name(word());
    word();  // the type
    const std::size_t components = next_is("lookup_table") ? 1 : component_count();
    if (next_is("lookup_table")) {
      word();
      word();  // the name of the table
    }
    read_numbers(name, components, tuples_);
  }

  void read_numbers(const std::string& name, std::size_t components, std::size_t tuples) {
    std::vector<double> values;
    for (std::size_t i = 0; i < components * tuples; ++i) values.push_back(number());
    if (!of_points_) return;
    const bool is_scalar = components == 1 && tuples == data_.points.size();
    point_arrays_[name] = is_scalar ? std::move(values) : std::vector<double>();
  }

  void skip_numbers(std::size_t components, std::size_t tuples) {
    for (std::size_t i = 0; i < components * tuples; ++i) number();
  }

  void skip_attribute(const std::string& keyword) {
    static const std::map<std::string, std::size_t> kComponents = {
        {"vectors", 3},    {"normals", 3},      {"tensors", 9},   {"tensors6", 6},
        {"global_ids", 1}, {"pedigree_ids", 1}, {"edge_flags", 1}};
    if (const auto known = kComponents.find(keyword); known != kComponents.end()) {
      word();  // its name
      word();  // its type
      skip_numbers(known->second, tuples_);
    } else if (keyword == "texture_coordinates") {
      word();
      const std::size_t components = component_count();
      word();
      skip_numbers(components, tuples_);
    } else if (keyword == "color_scalars") {
      word();
      skip_numbers(component_count(), tuples_);
    } else if (keyword == "lookup_table") {
      word();
      skip_numbers(4, count(4));
    } else {
      fail(cite(keyword) + " is no keyword of a legacy VTK file, or more numbers are there than announced");
    }
  }

  /// Of every element of the attribute at hand.
  std::size_t component_count() { return count(std::max<std::size_t>(tuples_, 1)); }

  /// Metadata end at an empty line.
  void skip_metadata() {
    std::string_view line;
    while (lines_.next(line) && !trim(line).empty()) {
    }
    fields_.clear();
    field_ = 0;
  }

  void set_radii() {
    if (data_.points.empty()) fail("there is no point in it");
    for (const std::string& name : radius_names(radius_array_)) {
      const auto found = point_arrays_.find(name);
      if (found == point_arrays_.end()) continue;
      if (found->second.empty()) {
        throw InvalidInput(source_ + ": the point array " + cite(name) + " must hold one number for every point");
      }
      for (std::size_t i = 0; i < data_.points.size(); ++i) data_.points[i].radius = found->second[i];
      return;
    }
    std::vector<std::string> present;
    for (const auto& [name, values] : point_arrays_) present.push_back(name);
    fail_without_radius(source_, radius_array_, present);
  }

  LineReader lines_;
  const std::string& source_;
  const std::string& radius_array_;
  std::vector<std::string_view> fields_;  ///< of the line at hand
  std::size_t field_ = 0;                 ///< the next of them
  LengthUnit unit_ = LengthUnit::unknown;
  Space space_ = Space::unknown;
  PolyLines data_;
  bool of_points_ = false;                                   ///< whether attributes at hand belong to points
  std::size_t tuples_ = 0;                                   ///< how many elements they belong to
  std::map<std::string, std::vector<double>> point_arrays_;  ///< empty when not one number per point
};

}  // namespace

RawCenterline parse_centerline_vtk(std::string_view content, const std::string& source,
                                   const std::string& radius_array) {
  return LegacyVtkReader(content, source, radius_array).run();
}

}  // namespace vmesh::io
