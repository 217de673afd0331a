#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "vmesh/core/stored_number.h"

#include "end_section_arrays.h"
#include "formats.h"
#include "poly_lines.h"
#include "text.h"
#include "triangulation.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

using Cells = std::vector<std::vector<Index>>;

/// What a file holds.
struct LegacyVtkData {
  std::vector<Vec3> points;
  Cells vertices, lines, polygons, strips;
  ScalarArrays point_arrays, cell_arrays;
  ScalarArrays field_arrays;            ///< of flat ends
  std::set<std::string> whole_numbers;  ///< the names of integer arrays
  LengthUnit unit = LengthUnit::unknown;
  Space space = Space::unknown;
};

/// Reads the format (VTK File Formats, "Simple Legacy Formats") up to version 5.1. After four header lines it is a
/// stream of words; in the binary variant, numbers and texts of arrays are big-endian bytes.
class LegacyVtkReader {
 public:
  /// `wanted`: what the file should contain, for messages.
  LegacyVtkReader(std::string_view content, const std::string& source, const char* wanted)
      : lines_(content), source_(source), wanted_(wanted) {}

  LegacyVtkData run() {
    read_header();
    for (std::string keyword; next_word(keyword);) read_block(keyword);
    if (data_.points.empty()) fail("it contains no point");
    return std::move(data_);
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
      fail("this is not a legacy VTK file: it does not begin with \"# vtk DataFile Version\"");
    }
    read_tags(header_line("the title"), data_.unit, data_.space);  // 3D Slicer puts SPACE=... there
    const std::string format = lower(header_line("the word ASCII or BINARY"));
    binary_ = format == "binary";
    if (!binary_ && format != "ascii") fail("the word ASCII or BINARY should be here, not " + cite(format));
    if (const std::string keyword = lower(word()); keyword != "dataset")
      fail(cite(keyword) + " stands where DATASET should");
    const std::string kind(word());
    if (lower(kind) != "polydata") {
      throw Unsupported(source_ + ": this is a data set of the kind " + cite(kind) + "; " + wanted_ + " is POLYDATA");
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

  /// The same where the bytes of an array may follow immediately.
  bool next_is_or_bytes(std::string_view keyword) {
    if (!binary_ || field_ != fields_.size()) return next_is(keyword);
    return lower(lines_.rest().substr(0, keyword.size())) == keyword;
  }

  double number() {
    const std::string_view text = word();
    const auto value = parse_double(text);
    if (!value) fail(cite(text) + " is not a number");
    return *value;
  }

  /// The numbers of an array, after the line that announces them.
  std::vector<double> numbers(std::size_t count, const std::string& type) {
    std::vector<double> values;
    if (!binary_) {
      for (std::size_t i = 0; i < count; ++i) values.push_back(number());
      return values;
    }
    if (type == "bit") {  // eight in a byte; skipped, as no array in use has this type
      bytes((count + 7) / 8);
      return values;
    }
    const NumberType kind = number_type(type);
    const std::string_view stored = bytes(count * size_of(kind));
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) values.push_back(number_at(&stored[i * size_of(kind)], kind, true));
    return values;
  }

  std::string_view bytes(std::size_t count) {
    if (field_ != fields_.size()) fail(cite(fields_[field_]) + " stands where the line should end");
    if (count > lines_.rest().size()) fail("the file ends too early; it is cut off, get the whole file");
    return lines_.take(count);
  }

  NumberType number_type(const std::string& name) const {
    static const std::map<std::string, NumberType> kTypes = {
        {"unsigned_char", NumberType::u8},  {"char", NumberType::i8},
        {"signed_char", NumberType::i8},    {"unsigned_short", NumberType::u16},
        {"short", NumberType::i16},         {"unsigned_int", NumberType::u32},
        {"int", NumberType::i32},           {"vtkidtype", NumberType::i32},
        {"unsigned_long", NumberType::u64}, {"long", NumberType::i64},
        {"vtktypeint64", NumberType::i64},  {"vtktypeuint64", NumberType::u64},
        {"float", NumberType::f32},         {"double", NumberType::f64}};
    const auto found = kTypes.find(name);
    if (found == kTypes.end()) fail("the type " + cite(name) + " is not known");
    return found->second;
  }

  /// The word that names the type of numbers.
  std::string type_word() { return lower(word()); }

  std::int64_t integer() {
    const std::string_view text = word();
    const auto value = parse_integer(text);
    if (!value) fail(cite(text) + " is not an integer");
    return *value;
  }

  /// Reads how many items follow that take at least a character and a blank each, or a bit.
  std::size_t count(std::size_t numbers_each = 1) {
    const std::int64_t value = integer();
    if (value < 0) fail("the count " + std::to_string(value) + " is negative");
    const std::size_t most = binary_ ? lines_.rest().size() * 8 + 1 : lines_.rest().size() / 2 + fields_.size() + 1;
    if (static_cast<std::size_t>(value) > most || static_cast<std::size_t>(value) * numbers_each > most) {
      fail("the count " + std::to_string(value) + " is more than the file can hold");
    }
    return static_cast<std::size_t>(value);
  }

  void read_block(const std::string& keyword) {
    if (keyword == "points") return read_points();
    if (keyword == "lines") return read_cells(data_.lines);
    if (keyword == "vertices") return read_cells(data_.vertices);
    if (keyword == "polygons") return read_cells(data_.polygons);
    if (keyword == "triangle_strips") return read_cells(data_.strips);
    if (keyword == "point_data" || keyword == "cell_data") return begin_attributes(keyword == "point_data");
    if (keyword == "field") return read_field();
    if (keyword == "scalars") return read_scalars();
    if (keyword == "metadata") return skip_metadata();
    skip_attribute(keyword);
  }

  void read_points() {
    if (!data_.points.empty()) fail("the points occur twice");
    const std::size_t size = count(3);
    const std::vector<double> x = numbers(3 * size, type_word());
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) data_.points.emplace_back(x[i], x[i + 1], x[i + 2]);
  }

  void read_cells(Cells& cells) {
    if (!cells.empty()) fail("cells of this kind occur twice");
    const std::size_t rows = count(), size = count();
    next_is_or_bytes("offsets") ? read_offset_cells(cells, rows, size) : read_counted_cells(cells, rows, size);
  }

  /// Up to version 4: a cell is its number of points followed by the points; `size` counts all these numbers.
  void read_counted_cells(Cells& cells, std::size_t rows, std::size_t size) {
    if (binary_) return read_counted_cells(cells, rows, numbers(size, "int"));
    std::size_t read = 0;
    for (std::size_t c = 0; c < rows; ++c) {
      const std::size_t points = count();
      read += 1 + points;
      if (read > size) break;
      auto& cell = cells.emplace_back();
      for (std::size_t i = 0; i < points; ++i) cell.push_back(point_index(number()));
    }
    if (read != size) fail_of_cells(size);
  }

  void read_counted_cells(Cells& cells, std::size_t rows, const std::vector<double>& all) {
    std::size_t read = 0;
    for (std::size_t c = 0; c < rows && read < all.size(); ++c) {
      const double points = all[read++];
      if (!(points >= 0 && points <= static_cast<double>(all.size() - read))) fail_of_cells(all.size());
      auto& cell = cells.emplace_back();
      for (double i = 0; i < points; ++i) cell.push_back(point_index(all[read++]));
    }
    if (cells.size() != rows || read != all.size()) fail_of_cells(all.size());
  }

  [[noreturn]] void fail_of_cells(std::size_t size) const {
    fail("the cells do not have the " + std::to_string(size) + " numbers that are announced");
  }

  /// From version 5: offsets of all cells and the end in a list of points.
  void read_offset_cells(Cells& cells, std::size_t rows, std::size_t size) {
    std::vector<std::size_t> offsets;
    for (const double offset : numbers(rows, array_head("offsets"))) {
      const std::size_t least = offsets.empty() ? 0 : offsets.back();
      if (!(offset >= static_cast<double>(least) && offset <= static_cast<double>(size)) ||
          offset != std::floor(offset)) {
        fail("the offset " + exact(offset) + " is out of range; it must be from " + std::to_string(least) + " to " +
             std::to_string(size));
      }
      offsets.push_back(static_cast<std::size_t>(offset));
    }
    std::vector<Index> points;
    for (const double id : numbers(size, array_head("connectivity"))) points.push_back(point_index(id));
    if (points.size() != size) fail_of_cells(size);
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      cells.emplace_back(points.data() + offsets[c], points.data() + offsets[c + 1]);
    }
  }

  /// Reads the header of an array of that name; returns its type.
  std::string array_head(std::string_view name) {
    if (!next_is(name)) fail("the word " + std::string(name) + " should follow");
    word();
    return type_word();
  }

  static std::string exact(double value) {
    std::string text;
    append(text, value);
    return text;
  }

  Index point_index(double index) const {
    if (!(index >= 0 && index < static_cast<double>(data_.points.size())) || index != std::floor(index)) {
      fail("there is no point " + exact(index) + "; there are " + std::to_string(data_.points.size()) +
           " before this line, the first is 0");
    }
    return static_cast<Index>(index);
  }

  void begin_attributes(bool of_points) {
    tuples_ = count();
    of_ = of_points ? Of::points : Of::cells;
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
      const std::string type = type_word();
      if (type == "string" || type == "utf8_string" || type == "variant") {
        read_texts(name, components * tuples);
      } else {
        read_numbers(name, components, tuples, type);
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
    if (binary_) return read_stored_texts(name, lines);
    std::string_view line;
    for (std::size_t i = 0; i < lines; ++i) {
      if (!lines_.next(line)) fail("the file ends too early; it is cut off, get the whole file");
      if (i == 0) read_tags(name + "=" + std::string(trim(line)), data_.unit, data_.space);
    }
    fields_.clear();
    field_ = 0;
  }

  /// Binary: every text is preceded by its length in 1, 2, 4 or 8 bytes; the first two bits tell how many.
  void read_stored_texts(const std::string& name, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (lines_.rest().empty()) bytes(1);  // fails
      const unsigned kind = static_cast<unsigned char>(lines_.rest()[0]) >> 6u;
      std::uint64_t length = 0;
      for (const char c : bytes(std::size_t{8} >> kind)) length = length << 8u | static_cast<unsigned char>(c);
      length &= (std::uint64_t{1} << ((64u >> kind) - 2)) - 1;
      if (length > lines_.rest().size()) fail("the file ends too early; it is cut off, get the whole file");
      const std::string_view text = bytes(static_cast<std::size_t>(length));
      if (i == 0) read_tags(name + "=" + std::string(text), data_.unit, data_.space);
    }
  }

  void read_scalars() {
    const std::string name(word());
    const std::string type = type_word();
    const bool is_one = binary_ ? field_ == fields_.size() : next_is("lookup_table");
    const std::size_t components = is_one ? 1 : component_count();
    if (next_is_or_bytes("lookup_table")) {
      word();
      word();  // the name of the table
    }
    read_numbers(name, components, tuples_, type);
  }

  void read_numbers(const std::string& name, std::size_t components, std::size_t tuples, const std::string& type) {
    std::vector<double> values = numbers(components * tuples, type);
    if (is_end_section_array(name)) data_.field_arrays[name] = values;
    if (of_ == Of::nothing) return;
    auto& arrays = of_ == Of::points ? data_.point_arrays : data_.cell_arrays;
    const bool is_scalar = components == 1 && tuples == tuples_ && values.size() == tuples;
    if (type != "float" && type != "double") data_.whole_numbers.insert(name);
    arrays[name] = is_scalar ? std::move(values) : std::vector<double>();
  }

  void skip_numbers(std::size_t components, std::size_t tuples, const std::string& type) {
    if (!binary_) {
      for (std::size_t i = 0; i < components * tuples; ++i) number();
    } else {
      bytes(type == "bit" ? (components * tuples + 7) / 8 : components * tuples * size_of(number_type(type)));
    }
  }

  void skip_attribute(const std::string& keyword) {
    static const std::map<std::string, std::size_t> kComponents = {
        {"vectors", 3},    {"normals", 3},      {"tensors", 9},   {"tensors6", 6},
        {"global_ids", 1}, {"pedigree_ids", 1}, {"edge_flags", 1}};
    if (const auto known = kComponents.find(keyword); known != kComponents.end()) {
      word();  // its name
      skip_numbers(known->second, tuples_, type_word());
    } else if (keyword == "texture_coordinates") {
      word();
      const std::size_t components = component_count();
      skip_numbers(components, tuples_, type_word());
    } else if (keyword == "color_scalars") {
      word();
      skip_numbers(component_count(), tuples_, "unsigned_char");
    } else if (keyword == "lookup_table") {
      word();
      skip_numbers(4, count(4), "unsigned_char");
    } else {
      fail(cite(keyword) + " is not a keyword of a legacy VTK file, or more numbers are there than announced");
    }
  }

  /// Reads the number of components per element of the current attribute.
  std::size_t component_count() { return count(std::max<std::size_t>(tuples_, 1)); }

  /// Skips metadata, which end at an empty line.
  void skip_metadata() {
    std::string_view line;
    while (lines_.next(line) && !trim(line).empty()) {
    }
    fields_.clear();
    field_ = 0;
  }

  LineReader lines_;
  const std::string& source_;
  const std::string wanted_;
  bool binary_ = false;
  std::vector<std::string_view> fields_;  ///< of the current line
  std::size_t field_ = 0;                 ///< the next field
  LegacyVtkData data_;
  enum class Of { nothing, points, cells };
  Of of_ = Of::nothing;     ///< what the current attributes belong to
  std::size_t tuples_ = 0;  ///< number of elements they belong to
};

/// The numbers of the elements `kept` from every array with one number per element.
template <class Names>
std::vector<MeshAttribute> attributes_of(const ScalarArrays& arrays, const LegacyVtkData& data, const Names& names,
                                         std::size_t count, const std::vector<std::size_t>& kept) {
  std::vector<MeshAttribute> result;
  for (const auto& [name, values] : arrays) {
    if (values.size() != count) continue;
    MeshAttribute attribute{from_vtk(names, name), {}, data.whole_numbers.contains(name)};
    attribute.values.reserve(kept.size());
    for (const std::size_t i : kept) attribute.values.push_back(values[i]);
    result.push_back(std::move(attribute));
  }
  return result;
}

}  // namespace

RawCenterline parse_centerline_vtk(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options) {
  LegacyVtkData data = LegacyVtkReader(content, source, "a centerline").run();
  PolyLines lines;
  for (const Vec3& point : data.points) lines.points.push_back({point, 0});
  lines.lines = std::move(data.lines);
  lines.vertices = std::move(data.vertices);
  RawCenterline raw = to_raw_centerline(std::move(lines), source, {data.point_arrays, data.cell_arrays}, options);
  read_end_sections(data.field_arrays, raw);
  raw.unit = data.unit;
  raw.space = data.space;
  return raw;
}

LoadedSurface parse_surface_vtk(std::string_view content, const std::string& source) {
  LegacyVtkData data = LegacyVtkReader(content, source, "a surface").run();
  LoadedSurface surface;
  surface.unit = data.unit;
  surface.space = data.space;
  surface.mesh.vertices = std::move(data.points);
  FaceCollector faces(surface, source);
  const std::size_t first_cell = data.vertices.size() + data.lines.size();
  const std::vector<std::size_t> cell_of_face = faces.add_cells(data.polygons, data.strips, first_cell);
  faces.finish();
  const std::size_t count = surface.mesh.vertices.size(),
                    cells = first_cell + data.polygons.size() + data.strips.size();
  std::vector<std::size_t> kept(count);
  std::iota(kept.begin(), kept.end(), 0);
  surface.attributes.vertex = attributes_of(data.point_arrays, data, kPointNames, count, kept);
  kept.clear();
  for (const Index f : faces.face_of_triangle()) kept.push_back(cell_of_face[f]);
  surface.attributes.face = attributes_of(data.cell_arrays, data, kCellNames, cells, kept);
  return surface;
}

}  // namespace vmesh::io
