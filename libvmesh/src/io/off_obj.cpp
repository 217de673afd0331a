#include <ostream>

#include "boundaries.h"
#include "comments.h"
#include "formats.h"
#include "named_patches.h"
#include "poly_lines.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

void append_row(std::string& row, const Vec3& p) {
  append(row, p.x());
  append(row += ' ', p.y());
  append(row += ' ', p.z());
}

class OffReader {
 public:
  OffReader(std::string_view content, const std::string& source) : lines_(content), source_(source) {}

  LoadedSurface run() {
    read_counts();
    surface_.mesh.vertices.reserve(vertex_count_);
    for (std::size_t v = 0; v < vertex_count_; ++v) read_vertex();
    FaceCollector faces(surface_, source_);
    for (std::size_t f = 0; f < face_count_; ++f) read_face(faces);
    faces.finish();
    for (std::string_view line; lines_.next(line);) {
      if (line.starts_with('#')) read_tags(line, surface_.unit, surface_.space);
    }
    return std::move(surface_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  void next_fields(const char* wanted) {
    std::string_view line;
    do {
      if (!lines_.next(line)) fail(std::string("the file ends where ") + wanted + " should be");
      const std::size_t hash = line.find('#');
      if (hash != std::string_view::npos) read_tags(line.substr(hash), surface_.unit, surface_.space);
      split_blank(line.substr(0, hash), fields_);
    } while (fields_.empty());
  }

  void read_counts() {
    next_fields("the word OFF");
    const std::string word = lower(fields_[0]);
    const std::size_t end = word.find("off");
    if (end == std::string::npos || end > 4) fail("an OFF file begins with the word OFF, not " + cite(fields_[0]));
    fields_[0].remove_prefix(end + 3);  // the counts may follow without a blank
    if (fields_[0].empty()) fields_.erase(fields_.begin());
    if (fields_.empty()) next_fields("the counts of vertices and faces");
    if (fields_[0] == "BINARY")
      throw Unsupported(source_ + ": binary OFF is not supported; save it as PLY or text OFF");
    if (fields_.size() < 2) fail("the counts of vertices and faces are needed");
    vertex_count_ = count(fields_[0]);
    face_count_ = count(fields_[1]);
  }

  std::size_t count(std::string_view field) const {
    const auto value = parse_integer(field);
    if (!value || *value < 0) fail(cite(field) + " is not a count");
    // Every vertex and face takes at least two characters.
    if (static_cast<std::uint64_t>(*value) > lines_.rest().size() / 2 + 1) {
      fail("the count " + std::to_string(*value) + " is more than the file can hold");
    }
    return static_cast<std::size_t>(*value);
  }

  void read_vertex() {
    next_fields("a vertex");
    if (fields_.size() < 3) fail("a vertex has three coordinates");
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const auto value = parse_double(fields_[static_cast<std::size_t>(i)]);
      if (!value) fail(cite(fields_[static_cast<std::size_t>(i)]) + " is not a number");
      p[i] = *value;
    }
    surface_.mesh.vertices.push_back(p);
  }

  void read_face(FaceCollector& faces) {
    next_fields("a face");
    const auto corner_count = parse_integer(fields_[0]);
    if (!corner_count || *corner_count < 0 || static_cast<std::size_t>(*corner_count) + 1 > fields_.size()) {
      fail("a face is its number of corners and their indices");
    }
    corners_.clear();
    for (std::size_t i = 1; i <= static_cast<std::size_t>(*corner_count); ++i) {
      const auto corner = parse_integer(fields_[i]);
      if (!corner) fail(cite(fields_[i]) + " is not a vertex index");
      corners_.push_back(*corner);
    }
    faces.add(corners_, "line " + std::to_string(lines_.number()));
  }

  LineReader lines_;
  const std::string& source_;
  LoadedSurface surface_;
  std::vector<std::string_view> fields_;
  std::vector<std::int64_t> corners_;
  std::size_t vertex_count_ = 0, face_count_ = 0;
};

class ObjReader {
 public:
  ObjReader(std::string_view content, const std::string& source)
      : lines_(content), source_(source), faces_(surface_, source) {}

  LoadedSurface run() {
    read_lines();
    // Faces may come before their vertices.
    for (const auto& [begin, end, number] : polygons_) {
      faces_.add({corners_.begin() + begin, corners_.begin() + end}, "line " + std::to_string(number));
    }
    faces_.finish();
    groups_.finish(surface_, faces_.face_of_triangle());
    return std::move(surface_);
  }

  RawCenterline run_as_centerline(const CenterlineReadOptions& options) {
    for_lines_ = true;
    read_lines();
    std::vector<std::vector<Index>> lines;
    for (const Polygon& path : polygons_) lines.push_back(points_of(path));
    return to_raw_centerline(std::move(surface_), std::move(lines), source_, options);
  }

 private:
  struct Polygon {
    std::ptrdiff_t begin, end;
    std::uint64_t line;
  };

  void read_lines() {
    std::string_view line;
    std::string continued;
    while (lines_.next(line)) {
      if (line.ends_with('\\')) {
        continued.append(line.substr(0, line.size() - 1)).append(" ");
        continue;
      }
      if (!continued.empty()) {
        continued.append(line);
        read_line(continued);
        continued.clear();
      } else {
        read_line(line);
      }
    }
  }

  std::vector<Index> points_of(const Polygon& path) const {
    std::vector<Index> points;
    for (std::ptrdiff_t i = path.begin; i < path.end; ++i) {
      const std::int64_t point = corners_[static_cast<std::size_t>(i)];
      if (point < 0 || static_cast<std::size_t>(point) >= surface_.mesh.vertices.size()) {
        throw InvalidInput(source_ + ": line " + std::to_string(path.line) + ": there is no vertex " +
                           std::to_string(point + 1) + "; there are " + std::to_string(surface_.mesh.vertices.size()));
      }
      points.push_back(static_cast<Index>(point));
    }
    return points;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(source_ + ": line " + std::to_string(lines_.number()) + ": " + what);
  }

  void read_line(std::string_view line) {
    const std::size_t hash = line.find('#');
    if (hash != std::string_view::npos) read_tags(line.substr(hash), surface_.unit, surface_.space);
    split_blank(line.substr(0, hash), fields_);
    if (fields_.empty()) return;
    if (fields_[0] == "v") read_vertex();
    if (fields_[0] == "g") groups_.begin(fields_.size() > 1 ? std::string(fields_[1]) : std::string());
    if (for_lines_ && fields_[0] == "f") fail("it has faces, so this is a surface; a centerline has lines (l) only");
    if (fields_[0] == (for_lines_ ? "l" : "f")) read_face();
  }

  void read_vertex() {
    if (fields_.size() < 4) fail("a vertex has three coordinates");
    Vec3 p;
    for (int i = 0; i < 3; ++i) {
      const auto value = parse_double(fields_[static_cast<std::size_t>(i) + 1]);
      if (!value) fail(cite(fields_[static_cast<std::size_t>(i) + 1]) + " is not a number");
      p[i] = *value;
    }
    surface_.mesh.vertices.push_back(p);
  }

  /// Of a face or line.
  void read_face() {
    const auto begin = static_cast<std::ptrdiff_t>(corners_.size());
    for (std::size_t i = 1; i < fields_.size(); ++i) {
      const auto corner = parse_integer(fields_[i].substr(0, fields_[i].find('/')));
      if (!corner || *corner == 0)
        fail(cite(fields_[i]) + " is not a vertex index; they count from 1, or back from -1");
      corners_.push_back(*corner > 0 ? *corner - 1
                                     : static_cast<std::int64_t>(surface_.mesh.vertices.size()) + *corner);
    }
    groups_.add_face();
    polygons_.push_back({begin, static_cast<std::ptrdiff_t>(corners_.size()), lines_.number()});
  }

  LineReader lines_;
  const std::string& source_;
  LoadedSurface surface_;
  FaceGroups groups_;
  FaceCollector faces_;
  std::vector<std::string_view> fields_;
  std::vector<std::int64_t> corners_;
  std::vector<Polygon> polygons_;  ///< faces, or lines
  bool for_lines_ = false;
};

}  // namespace

LoadedSurface parse_off(std::string_view content, const std::string& source) {
  return OffReader(content, source).run();
}

LoadedSurface parse_obj(std::string_view content, const std::string& source) {
  return ObjReader(content, source).run();
}

bool holds_obj_lines(std::string_view content) {
  LineReader lines(content);
  std::vector<std::string_view> fields;
  std::string_view line;
  bool has_lines = false;
  while (lines.next(line)) {
    if (line.starts_with('v')) continue;  // most of them
    split_blank(line, fields);
    if (fields.empty()) continue;
    if (fields[0] == "f") return false;
    has_lines = has_lines || fields[0] == "l";
  }
  return has_lines;
}

RawCenterline parse_centerline_obj(std::string_view content, const std::string& source,
                                   const CenterlineReadOptions& options) {
  return ObjReader(content, source).run_as_centerline(options);
}

void write_off(std::ostream& out, const TriMesh& mesh, const MeshAttributes&, const SurfaceMetadata& metadata,
               const SurfaceWriteOptions&) {
  out << "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.faces.size()) + " 0\n";
  std::string row;
  for (const Vec3& p : mesh.vertices) {
    row.clear();
    append_row(row, p);
    out << row << '\n';
  }
  for (const auto& [a, b, c] : mesh.faces) {
    out << "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  out << comments(metadata, "# ");  // at the end, where readers that do not accept comments no longer read
}

void write_obj(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata, const SurfaceWriteOptions&) {
  out << comments(metadata, "# ");
  std::string row;
  for (const Vec3& p : mesh.vertices) {
    row = "v ";
    append_row(row, p);
    out << row << '\n';
  }
  // One for each vertex, also where caps meet the wall: several programs take vertices with more of them apart.
  for (const Vec3& n : vertex_normals(mesh)) {
    row = "vn";
    for (const double x : n) append(row += ' ', static_cast<float>(x));
    out << row << '\n';
  }
  for (const auto& [name, faces] : boundaries_of(mesh, attributes)) {
    out << "g " << name << '\n';
    for (const Index f : faces) {
      row = "f";
      for (const Index v : mesh.faces[f]) {
        const std::string number = std::to_string(v + 1);
        row.append(" ").append(number).append("//").append(number);
      }
      out << row << '\n';
    }
  }
}

}  // namespace vmesh::io
