#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "vmesh/core/stored_number.h"

#include "formats.h"
#include "ply.h"
#include "poly_lines.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::f32;
  bool is_list = false;
  NumberType count_type = NumberType::u8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

std::optional<NumberType> type_of(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, NumberType>, 16> kNames = {{
      {"char", NumberType::i8},
      {"int8", NumberType::i8},
      {"uchar", NumberType::u8},
      {"uint8", NumberType::u8},
      {"short", NumberType::i16},
      {"int16", NumberType::i16},
      {"ushort", NumberType::u16},
      {"uint16", NumberType::u16},
      {"int", NumberType::i32},
      {"int32", NumberType::i32},
      {"uint", NumberType::u32},
      {"uint32", NumberType::u32},
      {"float", NumberType::f32},
      {"float32", NumberType::f32},
      {"double", NumberType::f64},
      {"float64", NumberType::f64},
  }};
  for (const auto& [key, type] : kNames) {
    if (key == name) return type;
  }
  return std::nullopt;
}

/// The values after the header, one by one, text or binary.
class PlyValues {
 public:
  enum class Encoding { text, little_endian, big_endian };

  PlyValues(std::string_view body, Encoding encoding, const std::string& source)
      : body_(body), encoding_(encoding), source_(source) {}

  /// A value takes at least this many bytes.
  std::size_t least_size(NumberType type) const { return encoding_ == Encoding::text ? 2 : size_of(type); }
  std::size_t left() const { return body_.size() - at_ + 1; }  // + 1: the last text value needs no separator

  double next(NumberType type, const std::string& element, std::uint64_t index) {
    if (encoding_ == Encoding::text) return next_text(element, index);
    const std::size_t size = size_of(type);
    if (body_.size() - at_ < size) fail_short(element, index);
    const char* bytes = body_.data() + at_;
    at_ += size;
    return number_at(bytes, type, encoding_ == Encoding::big_endian);
  }

 private:
  [[noreturn]] void fail_short(const std::string& element, std::uint64_t index) const {
    throw InvalidInput(source_ + ": " + one_line(element.substr(0, 40)) + " " + std::to_string(index) +
                       ": the file ends here; it is cut short");
  }

  double next_text(const std::string& element, std::uint64_t index) {
    constexpr std::string_view kBlank = " \t\r\n\v\f";
    const std::size_t begin = std::min(body_.find_first_not_of(kBlank, at_), body_.size());
    const std::size_t end = std::min(body_.find_first_of(kBlank, begin), body_.size());
    if (begin == end) fail_short(element, index);
    at_ = end;
    const auto value = parse_double(body_.substr(begin, end - begin));
    if (!value) {
      throw InvalidInput(source_ + ": " + one_line(element.substr(0, 40)) + " " + std::to_string(index) + ": " +
                         cite(body_.substr(begin, end - begin)) + " is not a number");
    }
    return *value;
  }

  std::string_view body_;
  std::size_t at_ = 0;
  Encoding encoding_;
  const std::string& source_;
};

class PlyReader {
 public:
  PlyReader(std::string_view content, const std::string& source) : lines_(content), source_(source) {}

  LoadedSurface run() {
    read_header();
    PlyValues values(lines_.rest(), encoding_, source_);
    FaceCollector faces(surface_, source_);
    // A face may come before the vertices; its corners are checked when all are known.
    for (const auto& element : elements_) read_element(element, values);
    for (std::size_t f = 0; f + 1 < face_offsets_.size(); ++f) {
      faces.add({corners_.begin() + face_offsets_[f], corners_.begin() + face_offsets_[f + 1]},
                "face " + std::to_string(f));
    }
    faces.finish();
    keep_face_attributes(faces.face_of_triangle());
    return std::move(surface_);
  }

  bool holds_lines() {
    read_header();
    return has("edge") && !has("face");
  }

  RawCenterline run_as_centerline(const CenterlineReadOptions& options) {
    for_lines_ = true;
    read_header();
    check_holds_lines();
    PlyValues values(lines_.rest(), encoding_, source_);
    for (const auto& element : elements_) read_element(element, values);
    std::vector<std::vector<Index>> lines;
    for (std::size_t e = 0; e + 1 < corners_.size(); e += 2) lines.push_back({end_of(e), end_of(e + 1)});
    return to_raw_centerline(std::move(surface_), std::move(lines), source_, options);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  void read_header() {
    std::string_view line;
    if (!lines_.next(line) || trim(line) != "ply") fail("this is not a PLY file: its first line must be \"ply\"");
    bool has_format = false;
    while (true) {
      if (!lines_.next(line)) fail("the header has no end (end_header)");
      split_blank(line, fields_);
      if (fields_.empty()) continue;
      if (fields_[0] == "end_header") break;
      if (fields_[0] == "format") {
        read_format();
        has_format = true;
      } else if (fields_[0] == "comment" || fields_[0] == "obj_info") {
        read_tags(line, surface_.unit, surface_.space);
        if (trim(line) == kSkewnessComment) quality_is_skewness_ = true;
        if (line.starts_with(kPatchComment)) read_patch_name();
      } else if (fields_[0] == "element") {
        read_element_line();
      } else if (fields_[0] == "property") {
        read_property_line();
      } else {
        fail("the header line begins with " + cite(fields_[0]) + ", which PLY does not know");
      }
    }
    if (!has_format) fail("the header does not say its format (ascii, binary_little_endian, binary_big_endian)");
  }

  /// "comment patch 1 wall", in the order of their numbers.
  void read_patch_name() {
    std::vector<std::string>& names = surface_.attributes.patch_names;
    if (fields_.size() == 4 && parse_integer(fields_[2]) == static_cast<std::int64_t>(names.size() + 1))
      names.emplace_back(fields_[3]);
  }

  bool has(std::string_view element) const {
    return std::any_of(elements_.begin(), elements_.end(),
                       [&](const PlyElement& e) { return e.name == element && e.count > 0; });
  }

  void check_holds_lines() const {
    if (has("face")) fail("it has faces, so this is a surface; a centerline has vertices and edges only");
    if (!has("edge")) fail("it has no edges; a centerline has an element edge with vertex1 and vertex2");
  }

  /// The point at end `i` of the edges, two each.
  Index end_of(std::size_t i) const {
    if (corners_[i] < 0 || static_cast<std::size_t>(corners_[i]) >= surface_.mesh.vertices.size()) {
      throw InvalidInput(source_ + ": edge " + std::to_string(i / 2) +
                         ": it runs to a vertex that is not there; the "
                         "vertices are 0 to " +
                         std::to_string(static_cast<std::ptrdiff_t>(surface_.mesh.vertices.size()) - 1));
    }
    return static_cast<Index>(corners_[i]);
  }

  void read_format() {
    const std::string_view name = fields_.size() > 1 ? fields_[1] : std::string_view();
    if (name == "ascii") {
      encoding_ = PlyValues::Encoding::text;
    } else if (name == "binary_little_endian") {
      encoding_ = PlyValues::Encoding::little_endian;
    } else if (name == "binary_big_endian") {
      encoding_ = PlyValues::Encoding::big_endian;
    } else {
      fail("the format " + cite(name) + " is not known (ascii, binary_little_endian, binary_big_endian)");
    }
  }

  void read_element_line() {
    const auto count = fields_.size() == 3 ? parse_integer(fields_[2]) : std::nullopt;
    if (!count || *count < 0) fail("an element has a name and a count");
    if (!element_names_.emplace(fields_[1]).second) fail("the element " + cite(fields_[1]) + " occurs twice");
    elements_.push_back({std::string(fields_[1]), static_cast<std::uint64_t>(*count), {}});
  }

  NumberType type(std::string_view name) const {
    const auto result = type_of(name);
    if (!result) fail("the type " + cite(name) + " is not known");
    return *result;
  }

  void read_property_line() {
    if (elements_.empty()) fail("a property must follow an element");
    PlyProperty property;
    if (fields_.size() == 5 && fields_[1] == "list") {
      property = {std::string(fields_[4]), type(fields_[3]), true, type(fields_[2])};
    } else if (fields_.size() == 3) {
      property = {std::string(fields_[2]), type(fields_[1])};
    } else {
      fail("a property is `property TYPE NAME` or `property list TYPE TYPE NAME`");
    }
    elements_.back().properties.push_back(std::move(property));
  }

  /// Before anything is allocated: can the file hold that many?
  void check_count(const PlyElement& element, const PlyValues& values) const {
    std::size_t least = 0;
    for (const auto& p : element.properties) least += values.least_size(p.is_list ? p.count_type : p.type);
    if (least == 0 || element.count <= values.left() / least) return;
    throw InvalidInput(source_ + ": the header promises " + std::to_string(element.count) + " of element " +
                       cite(element.name) + ", the file has room for " + std::to_string(values.left() / least) +
                       "; it is cut short or broken");
  }

  void read_element(const PlyElement& element, PlyValues& values) {
    if (element.properties.empty()) return;
    check_count(element, values);
    if (element.count >= kNone) throw InvalidInput(source_ + ": too many of element " + cite(element.name));
    if (element.name == "vertex") {
      read_vertices(element, values);
    } else if (element.name == "face") {
      read_faces(element, values);
    } else if (for_lines_ && element.name == "edge") {
      read_edges(element, values);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const auto& p : element.properties) skip(p, values, element.name, i);
      }
    }
  }

  std::size_t list_size(const PlyProperty& p, PlyValues& values, const std::string& element, std::uint64_t i) const {
    const double count = values.next(p.count_type, element, i);
    if (!(count >= 0) || count != std::floor(count) ||
        count > static_cast<double>(values.left() / values.least_size(p.type))) {
      throw InvalidInput(source_ + ": " + one_line(element.substr(0, 40)) + " " + std::to_string(i) + ": the list " +
                         cite(p.name) + " has an impossible length");
    }
    return static_cast<std::size_t>(count);
  }

  void skip(const PlyProperty& p, PlyValues& values, const std::string& element, std::uint64_t i) const {
    const std::size_t count = p.is_list ? list_size(p, values, element, i) : 1;
    for (std::size_t k = 0; k < count; ++k) values.next(p.type, element, i);
  }

  static std::vector<MeshAttribute> declare_attributes(const PlyElement& element, std::uint64_t count,
                                                       bool (*is_attribute)(const PlyProperty&)) {
    std::vector<MeshAttribute> attributes;
    for (const auto& p : element.properties) {
      if (!is_attribute(p)) continue;
      attributes.push_back({p.name, {}, p.type != NumberType::f32 && p.type != NumberType::f64});
      attributes.back().values.reserve(count);
    }
    return attributes;
  }

  static bool is_vertex_attribute(const PlyProperty& p) {
    if (p.is_list) return false;
    for (const char* own : {"x", "y", "z", "nx", "ny", "nz"}) {
      if (p.name == own) return false;
    }
    return true;
  }

  static bool is_face_attribute(const PlyProperty& p) { return !p.is_list; }

  void read_vertices(const PlyElement& element, PlyValues& values) {
    int coordinates = 0;
    for (const auto& p : element.properties)
      coordinates += !p.is_list && (p.name == "x" || p.name == "y" || p.name == "z");
    if (coordinates != 3) throw InvalidInput(source_ + ": the vertices must have the properties x, y and z");
    auto& attributes = surface_.attributes.vertex;
    attributes = declare_attributes(element, element.count, is_vertex_attribute);
    surface_.mesh.vertices.reserve(element.count);
    struct Column {
      int axis = -1;                          // of the position
      std::vector<double>* values = nullptr;  // of an attribute
    };
    std::vector<Column> columns;
    std::size_t next_attribute = 0;
    for (const auto& p : element.properties) {
      Column& column = columns.emplace_back();
      if (!p.is_list && (p.name == "x" || p.name == "y" || p.name == "z")) column.axis = p.name[0] - 'x';
      if (is_vertex_attribute(p)) column.values = &attributes[next_attribute++].values;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Vec3 position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const PlyProperty& p = element.properties[c];
        if (p.is_list) {
          skip(p, values, element.name, i);
          continue;
        }
        const double value = values.next(p.type, element.name, i);
        if (columns[c].axis >= 0) position[columns[c].axis] = value;
        if (columns[c].values != nullptr) columns[c].values->push_back(value);
      }
      surface_.mesh.vertices.push_back(position);
    }
  }

  void read_faces(const PlyElement& element, PlyValues& values) {
    auto& attributes = surface_.attributes.face;
    attributes = declare_attributes(element, element.count, is_face_attribute);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::size_t next_attribute = 0;
      for (const auto& p : element.properties) {
        if (p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index")) {
          const std::size_t count = list_size(p, values, element.name, i);
          for (std::size_t k = 0; k < count; ++k) corners_.push_back(corner(values.next(p.type, element.name, i)));
        } else if (p.is_list) {
          skip(p, values, element.name, i);
        } else {
          attributes[next_attribute++].values.push_back(values.next(p.type, element.name, i));
        }
      }
      face_offsets_.push_back(static_cast<std::ptrdiff_t>(corners_.size()));
    }
  }

  void read_edges(const PlyElement& element, PlyValues& values) {
    int ends = 0;
    for (const auto& p : element.properties) ends += !p.is_list && (p.name == "vertex1" || p.name == "vertex2");
    if (ends != 2) throw InvalidInput(source_ + ": the edges must have the properties vertex1 and vertex2");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const auto& p : element.properties) {
        if (!p.is_list && (p.name == "vertex1" || p.name == "vertex2")) {
          corners_.push_back(corner(values.next(p.type, element.name, i)));
        } else {
          skip(p, values, element.name, i);
        }
      }
    }
  }

  static std::int64_t corner(double value) {
    return value >= 0 && value < 0x1p53 ? static_cast<std::int64_t>(value) : -1;
  }

  void keep_face_attributes(const std::vector<Index>& face_of_triangle) {
    for (auto& attribute : surface_.attributes.face) {
      std::vector<double> values;
      values.reserve(face_of_triangle.size());
      for (const Index f : face_of_triangle) values.push_back(attribute.values[f]);
      attribute.values = std::move(values);
      if (quality_is_skewness_ && attribute.name == "quality") attribute.name = kSkewnessName;
    }
  }

  LineReader lines_;
  const std::string& source_;
  LoadedSurface surface_;
  std::vector<std::string_view> fields_;
  PlyValues::Encoding encoding_ = PlyValues::Encoding::text;
  std::vector<PlyElement> elements_;
  std::unordered_set<std::string> element_names_;
  std::vector<std::int64_t> corners_;
  std::vector<std::ptrdiff_t> face_offsets_ = {0};
  bool quality_is_skewness_ = false, for_lines_ = false;
};

}  // namespace

LoadedSurface parse_ply(std::string_view content, const std::string& source) {
  return PlyReader(content, source).run();
}

bool holds_ply_edges(std::string_view content) { return PlyReader(content, "").holds_lines(); }

RawCenterline parse_centerline_ply(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options) {
  return PlyReader(content, source).run_as_centerline(options);
}

}  // namespace vmesh::io
