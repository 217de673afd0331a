// Spatial graphs of Amira and Avizo ("AmiraMesh" format): a header of declarations, then blocks of numbers.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include <Eigen/Dense>
#include <zlib.h>

#include "vmesh/core/stored_number.h"

#include "edge_radii.h"
#include "formats.h"
#include "radius_array.h"
#include "text.h"

namespace vmesh::io {
namespace {

constexpr std::uint64_t kBestRatio = 1032;  // zlib's largest compression ratio

/// `POINT { float thickness } @5(HxZip,123)`
struct Declaration {
  std::string location, name;  ///< location in lower case
  NumberType type;
  std::size_t components = 1;
  std::string packing;  ///< empty: none
  std::size_t packed_size = 0;
  std::vector<double> values;
  bool is_there = false;
};

class AmiraReader {
 public:
  AmiraReader(std::string_view content, const std::string& source, const CenterlineReadOptions& options)
      : lines_(content), options_(options) {
    raw_.source = source;
    raw_.node_word = "edge point";
    raw_.segment_word = "edge";
  }

  RawCenterline run() {
    read_header();
    choose_arrays();
    do {
      read_block();
    } while (next_block());
    build();
    transform();
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(raw_.source + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  void read_header() {
    if (!lines_.next(line_)) fail("the file is empty");
    const std::string first = lower(line_);
    if (!first.starts_with("# amiramesh") && !first.starts_with("# avizo"))
      fail("this is not an Amira file: it does not begin with \"# AmiraMesh\" or \"# Avizo\"");
    ascii_ = first.find("ascii") != std::string::npos;
    if (!ascii_ && first.find("binary") == std::string::npos) fail("the first line says neither ASCII nor BINARY");
    big_endian_ = first.find("little-endian") == std::string::npos;
    while (next_line()) {
      if (line_.starts_with('@')) return;
      if (!line_.starts_with('#')) read_header_line();
    }
    fail("the file ends before its data; it is cut off, get the whole file");
  }

  /// Reads the next line that is not blank, trimmed.
  bool next_line() {
    do {
      if (!lines_.next(line_)) return false;
      line_ = trim(line_);
    } while (line_.empty());
    return true;
  }

  void read_header_line() {
    split_blank(line_, fields_);
    const std::string keyword = lower(fields_[0]);
    if (keyword == "define") return read_count();
    const std::size_t at = line_.find('@');
    const std::size_t open = line_.find('{'), close = line_.rfind('}');
    if (depth_ == 0 && at != std::string_view::npos && open != std::string_view::npos &&
        close != std::string_view::npos && open < close && close < at) {
      return declare(trim(line_.substr(0, open)), trim(line_.substr(open + 1, close - open - 1)), line_.substr(at));
    }
    if (const std::size_t unit = line_.find("Coordinates \""); unit != std::string_view::npos) {
      const std::string_view text = line_.substr(unit + std::string_view("Coordinates \"").size());
      if (const auto known = parse_length_unit(text.substr(0, text.find('"')))) raw_.unit = *known;
    }
    if (depth_ == 1 && keyword == "transformationmatrix") read_transformation();
    count_braces();
  }

  /// Those in quotes are text.
  void count_braces() {
    bool quoted = false;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      const char c = line_[i];
      if (quoted && c == '\\') {
        ++i;
      } else if (c == '"') {
        quoted = !quoted;
      } else if (!quoted) {
        depth_ += c == '{' ? 1 : c == '}' ? -1 : 0;
      }
    }
  }

  /// Four numbers for what the x axis becomes, four for y and z each, and four for the origin.
  void read_transformation() {
    Eigen::Matrix4d matrix;
    if (fields_.size() != 17) fail("a TransformationMatrix has 16 numbers");
    for (int i = 0; i < 16; ++i) {
      std::string_view field = fields_[static_cast<std::size_t>(i) + 1];
      if (field.ends_with(',')) field.remove_suffix(1);
      const auto value = parse_double(field);
      if (!value || !std::isfinite(*value)) fail(cite(field) + " is not a number");
      matrix(i % 4, i / 4) = *value;
    }
    axes_ = matrix.topLeftCorner<3, 3>();
    shift_ = matrix.topRightCorner<3, 1>();
    factor_ = std::cbrt(std::abs(axes_.determinant()));
    constexpr double kRounding = 1e-5;
    const bool is_affine = matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
    // Written so that NaN fails.
    if (!is_affine || !(factor_ > 0) || !(axes_ / factor_ * (axes_ / factor_).transpose()).isIdentity(kRounding)) {
      fail(
          "the TransformationMatrix skews, or stretches some axes more than others, so that vessels would not be round;"
          " apply the transform in Amira and save the graph again");
    }
  }

  /// Places the graph where Amira shows it.
  void transform() {
    for (CenterlineNode& node : raw_.nodes) {
      node.position = axes_ * node.position + shift_;
      node.radius *= factor_;
    }
  }

  void read_count() {
    const auto count = parse_integer(fields_.size() == 3 ? fields_[2] : std::string_view());
    if (!count || *count < 0) fail("\"define\" must be followed by a name and a count");
    counts_[lower(fields_[1])] = static_cast<std::size_t>(*count);
  }

  /// `location { what } where`
  void declare(std::string_view location, std::string_view what, std::string_view where) {
    split_blank(what, fields_);
    if (fields_.size() != 2) fail("a declaration is \"LOCATION { type name } @number\"");
    Declaration made;
    made.location = lower(location);
    made.name = std::string(fields_[1]);
    read_type(fields_[0], made);
    const std::size_t bracket = where.find('(');
    const auto number = parse_integer(trim(where.substr(1, bracket == std::string_view::npos ? bracket : bracket - 1)));
    if (!number) fail(cite(where) + " is not a place in the file; @ and a number should be here");
    if (bracket != std::string_view::npos) read_packing(where.substr(bracket + 1), made);
    if (!declarations_.try_emplace(*number, std::move(made)).second)
      fail("the place @" + std::to_string(*number) + " was used before");
  }

  void read_type(std::string_view text, Declaration& made) const {
    static const std::map<std::string, NumberType> kTypes = {
        {"byte", NumberType::u8},   {"char", NumberType::i8},   {"short", NumberType::i16}, {"ushort", NumberType::u16},
        {"int", NumberType::i32},   {"int32", NumberType::i32}, {"uint", NumberType::u32},  {"long", NumberType::i64},
        {"int64", NumberType::i64}, {"float", NumberType::f32}, {"double", NumberType::f64}};
    const std::size_t bracket = text.find('[');
    const auto known = kTypes.find(lower(text.substr(0, bracket)));
    if (known == kTypes.end()) fail("the type " + cite(text) + " is not known");
    made.type = known->second;
    if (bracket == std::string_view::npos) return;
    constexpr std::int64_t kMost = 16;
    const std::string_view inside = text.substr(bracket + 1);
    const auto components = parse_integer(inside.substr(0, inside.find(']')));
    if (!components || *components < 1 || *components > kMost) fail("the type " + cite(text) + " is not known");
    made.components = static_cast<std::size_t>(*components);
  }

  /// `HxZip,123)`
  void read_packing(std::string_view text, Declaration& made) const {
    const std::size_t comma = text.find(','), end = text.find(')');
    if (comma == std::string_view::npos || end == std::string_view::npos || end < comma)
      fail("the compression " + cite(text) + " is not known");
    const auto size = parse_integer(trim(text.substr(comma + 1, end - comma - 1)));
    if (!size || *size < 0) fail("the compressed size in " + cite(text) + " is not a count");
    made.packing = lower(trim(text.substr(0, comma)));
    made.packed_size = static_cast<std::size_t>(*size);
    if (made.packing != "hxzip" && made.packing != "hxbyterle") {
      throw Unsupported(raw_.source + ": line " + std::to_string(lines_.number()) + ": the compression " +
                        cite(made.packing) + " is not supported; save the graph uncompressed");
    }
  }

  Declaration* find(std::string_view location, const std::string& name) {
    for (auto& [number, declaration] : declarations_) {
      if (declaration.location == location && lower(declaration.name) == lower(name)) return &declaration;
    }
    return nullptr;
  }

  Declaration& need(std::string_view location, const std::string& name, std::size_t components) {
    Declaration* found = find(location, name);
    if (found == nullptr || found->components != components)
      fail("this is not a spatial graph: the header declares no " + name + " with " + std::to_string(components) +
           " numbers each");
    return *found;
  }

  void choose_arrays() {
    vertices_ = &need("vertex", "VertexCoordinates", 3);
    edges_ = &need("edge", "EdgeConnectivity", 2);
    sizes_ = &need("edge", "NumEdgePoints", 1);
    points_ = &need("point", "EdgePointCoordinates", 3);
    std::vector<std::string> names = {"MaximumInscribedSphereRadius", "Radius", "Thickness", "Radii", "Diameter"};
    if (!options_.radius_array.empty()) names = {options_.radius_array};
    for (const char* location : {"point", "edge"}) {
      for (const std::string& name : names) {
        Declaration* found = find(location, name);
        if (found != nullptr && found->components == 1 && radii_ == nullptr) radii_ = found;
      }
    }
    if (radii_ != nullptr || (options_.radius && options_.radius_array.empty())) return;
    std::string present;
    std::size_t named = 0;
    for (const auto& [number, declaration] : declarations_) {
      constexpr std::size_t kMostNamed = 8;
      if (declaration.components == 1 && &declaration != sizes_ && named++ < kMostNamed)
        present += (present.empty() ? "" : ", ") + one_line(declaration.name.substr(0, 40));
    }
    fail("there is no radius or thickness of points or edges; it has " + (present.empty() ? "none" : present) +
         "; name the array with --radius-array, or give one radius for all with --radius");
  }

  bool next_block() {
    while (next_line()) {
      if (line_.starts_with('@')) return true;
      if (!line_.starts_with('#')) fail(cite(line_) + " stands where a block of data, @ and a number, should begin");
    }
    return false;
  }

  void read_block() {
    const auto number = parse_integer(line_.substr(1));
    const auto found = number ? declarations_.find(*number) : declarations_.end();
    if (found == declarations_.end()) fail(cite(line_) + " is not a place that the header declares");
    Declaration& block = found->second;
    if (block.is_there) fail("the block " + cite(line_) + " occurs twice");
    block.is_there = true;
    const auto count = counts_.find(block.location);
    if (count == counts_.end()) fail("the header does not \"define\" how many " + cite(block.location) + " there are");
    const bool needed =
        &block == vertices_ || &block == edges_ || &block == sizes_ || &block == points_ || &block == radii_;
    // A number takes at least a byte, before compression.
    const std::uint64_t most = (lines_.rest().size() + 1) * (block.packing.empty() ? 1 : kBestRatio);
    if (count->second > most || count->second * block.components > most)
      fail("the count " + std::to_string(count->second) + " is more than the file can hold");
    ascii_ ? read_text(block, count->second * block.components, needed)
           : read_bytes(block, count->second * block.components, needed);
  }

  void read_text(Declaration& block, std::size_t count, bool needed) {
    std::size_t read = 0;
    while (read < count) {
      if (!next_line()) fail("the file ends too early; it is cut off, get the whole file");
      split_blank(line_, fields_);
      if (fields_.size() > count - read) fail("there are more numbers than the header announces");
      for (const std::string_view field : fields_) {
        const auto value = parse_double(field);
        if (!value) fail(cite(field) + " is not a number");
        if (needed) block.values.push_back(*value);
        ++read;
      }
    }
  }

  void read_bytes(Declaration& block, std::size_t count, bool needed) {
    const std::size_t size = count * size_of(block.type);
    const std::size_t stored = block.packing.empty() ? size : block.packed_size;
    if (stored > lines_.rest().size()) fail("the file ends too early; it is cut off, get the whole file");
    std::string_view bytes = lines_.take(stored);
    if (!needed) return;
    std::string unpacked;
    if (!block.packing.empty()) {
      unpacked = block.packing == "hxzip" ? inflated(bytes, size) : run_lengths_undone(bytes, size);
      bytes = unpacked;
    }
    block.values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      block.values.push_back(number_at(bytes.data() + i * size_of(block.type), block.type, big_endian_));
  }

  std::string inflated(std::string_view packed, std::size_t size) const {
    if (size / kBestRatio > packed.size()) fail("the compressed block is too small for its contents");
    std::string bytes(size, '\0');
    uLongf written = size;
    const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &written,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (result != Z_OK || written != size) fail("the packed block is damaged");
    return bytes;
  }

  /// Decodes run lengths: a byte up to 127 is the number of times that the next one is repeated; the low 7 bits of a
  /// larger one count literal bytes.
  std::string run_lengths_undone(std::string_view packed, std::size_t size) const {
    std::string bytes;
    for (std::size_t i = 0; i < packed.size() && bytes.size() < size;) {
      const auto head = static_cast<unsigned char>(packed[i++]);
      const std::size_t count = head & 127u, left = packed.size() - i;
      if (left < (head < 128 ? 1 : count)) break;
      if (head < 128) {
        bytes.append(count, packed[i++]);
      } else {
        bytes.append(packed.substr(i, count));
        i += count;
      }
    }
    if (bytes.size() != size) fail("the packed block is damaged");
    return bytes;
  }

  void build() {
    for (const Declaration* wanted : {vertices_, edges_, sizes_, points_}) {
      if (!wanted->is_there) fail("the data of " + wanted->name + " are not there; the file is cut off");
    }
    if (radii_ != nullptr && !radii_->is_there) fail("the data of " + one_line(radii_->name) + " are not there");
    if (radii_ != nullptr) array_.emplace(radii_->name);
    vertex_node_.assign(vertices_->values.size() / 3, kNone);
    const bool per_edge = radii_ != nullptr && radii_->location == "edge";
    std::size_t first = 0;
    for (std::size_t e = 0; e < sizes_->values.size(); ++e) {
      const double size = sizes_->values[e];
      if (!(size >= 0 && size <= static_cast<double>(points_->values.size() / 3 - first)))
        fail("edge " + std::to_string(e) + " has more points than there are");
      add_edge(e, first, static_cast<std::size_t>(size), per_edge);
      first += static_cast<std::size_t>(size);
    }
    if (raw_.segments.empty()) fail("it contains no edge");
    const auto unused = std::count(vertex_node_.begin(), vertex_node_.end(), kNone);
    if (unused > 0)
      raw_.warnings.push_back(raw_.source + ": " + std::to_string(unused) + " vertices belong to no edge; left out");
    if (array_) array_->note(raw_);
    if (radii_ != nullptr && lower(radii_->name) == "thickness")
      raw_.warnings.push_back(raw_.source + ": " + one_line(radii_->name) + " is taken as the radius, as in Amira");
    if (per_edge) set_radii_of_segments(raw_, segment_radii_);
  }

  static Vec3 position(const Declaration& of, std::size_t i) {
    return {of.values[3 * i], of.values[3 * i + 1], of.values[3 * i + 2]};
  }

  double point_radius(std::size_t point) const {
    return radii_ != nullptr && radii_->location == "point" ? array_->radius(radii_->values[point]) : 0;
  }

  /// The node of vertex number `end` of the edge; its radius is the largest that an edge gives it.
  Index vertex(std::size_t edge, std::size_t end, std::size_t point, bool has_point) {
    const double id = edges_->values[2 * edge + end];
    if (!(id >= 0 && id < static_cast<double>(vertex_node_.size())))
      fail("edge " + std::to_string(edge) + " runs to a vertex that is not there");
    Index& node = vertex_node_[static_cast<std::size_t>(id)];
    if (node == kNone) {
      node = static_cast<Index>(raw_.nodes.size());
      raw_.nodes.push_back({position(*vertices_, static_cast<std::size_t>(id)), 0});
      raw_.node_numbers.push_back(point);
    }
    if (has_point) raw_.nodes[node].radius = std::max(raw_.nodes[node].radius, point_radius(point));
    return node;
  }

  bool lies_at(std::size_t point, Index node) const {
    constexpr double kSame = 1e-5;  // a hundred times the resolution of single precision
    const Vec3 p = position(*points_, point), q = raw_.nodes[node].position;
    return (p - q).norm() <= kSame * std::max(p.norm(), q.norm());
  }

  void add_edge(std::size_t edge, std::size_t first, std::size_t size, bool per_edge) {
    const std::size_t end = first + size;
    const Index a = vertex(edge, 0, first, size > 0), b = vertex(edge, 1, end - (size > 0 ? 1 : 0), size > 0);
    raw_.path_starts.push_back(static_cast<Index>(raw_.segments.size()));
    Index before = a;
    const auto join = [&](Index node) {
      raw_.segments.push_back({before, node});
      raw_.segment_numbers.push_back(edge);
      if (per_edge) segment_radii_.push_back(array_->radius(radii_->values[edge]));
      before = node;
    };
    for (std::size_t point = first; point < end; ++point) {
      // The list of an edge's points begins and ends with its vertices.
      if ((point == first && lies_at(point, a)) || (point + 1 == end && lies_at(point, b))) continue;
      raw_.nodes.push_back({position(*points_, point), point_radius(point)});
      raw_.node_numbers.push_back(point);
      join(static_cast<Index>(raw_.nodes.size() - 1));
    }
    join(b);
  }

  LineReader lines_;
  const CenterlineReadOptions& options_;
  RawCenterline raw_;
  std::string_view line_;
  std::vector<std::string_view> fields_;
  bool ascii_ = true, big_endian_ = true;
  int depth_ = 0;                              ///< of the braces that are open
  std::map<std::string, std::size_t> counts_;  ///< by lower-case name
  std::map<std::int64_t, Declaration> declarations_;
  Declaration *vertices_ = nullptr, *edges_ = nullptr, *sizes_ = nullptr, *points_ = nullptr, *radii_ = nullptr;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< with shift_, the TransformationMatrix
  Vec3 shift_ = Vec3::Zero();
  double factor_ = 1;                 ///< of lengths, under axes_
  std::optional<RadiusArray> array_;  ///< what radii_ holds
  std::vector<Index> vertex_node_;
  std::vector<double> segment_radii_;
};

}  // namespace

RawCenterline parse_amira(std::string_view content, const std::string& source, const CenterlineReadOptions& options) {
  return AmiraReader(content, source, options).run();
}

}  // namespace vmesh::io
