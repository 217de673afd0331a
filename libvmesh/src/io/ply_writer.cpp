#include <algorithm>
#include <concepts>
#include <ostream>

#include "vmesh/core/atomic_file.h"
#include "vmesh/core/error.h"
#include "vmesh/io/ply_stream.h"

#include "bytes.h"
#include "comments.h"
#include "formats.h"
#include "ply.h"

namespace vmesh::io {
namespace {

bool is_color(const MeshAttribute& attribute) {
  return attribute.name == "red" || attribute.name == "green" || attribute.name == "blue" || attribute.name == "alpha";
}

void declare(std::string& header, const MeshAttribute& attribute, const std::string& name) {
  const char* type = is_color(attribute) ? "uchar " : attribute.integer ? "int " : "double ";
  header += std::string("property ") + type + name + "\n";
}

/// The body of a file: binary, or text with a line for each vertex and face.
class PlyBody {
 public:
  PlyBody(std::ostream& out, std::string& bytes, SurfaceEncoding encoding)
      : out_(out), bytes_(bytes), is_text_(encoding == SurfaceEncoding::text) {}

  void add(double value) {
    if (is_text_) {
      append(bytes_, value);
    } else {
      store(bytes_, value);
    }
    separate();
  }
  template <std::integral Integer>
  void add(Integer value) {
    if (is_text_) {
      bytes_ += std::to_string(value);
    } else {
      store(bytes_, value);
    }
    separate();
  }
  void add(const MeshAttribute& attribute, std::size_t i) {
    if (is_color(attribute)) {
      add(static_cast<std::uint8_t>(std::clamp(attribute.values[i], 0.0, 255.0)));
    } else if (attribute.integer) {
      add(static_cast<std::int32_t>(attribute.values[i]));
    } else {
      add(attribute.values[i]);
    }
  }
  void end_row() {
    if (is_text_) bytes_.back() = '\n';
    write_blocks(out_, bytes_);
  }

 private:
  void separate() {
    if (is_text_) bytes_ += ' ';
  }

  std::ostream& out_;
  std::string& bytes_;
  bool is_text_;
};

/// PLY names are single words.
std::string word(const std::string& name) {
  std::string result = one_line(name);
  for (char& c : result) {
    if (c == ' ') c = '_';
  }
  return result;
}

std::string header_of(std::size_t vertices, std::size_t faces, const MeshAttributes& attributes,
                      const SurfaceMetadata& metadata, SurfaceEncoding encoding) {
  const std::string format = encoding == SurfaceEncoding::text ? "ascii" : "binary_little_endian";
  std::string bytes = "ply\nformat " + format + " 1.0\n" + comments(metadata, "comment ");
  for (const auto& a : attributes.face) {
    if (a.name == kSkewnessName) bytes += std::string(kSkewnessComment) + "\n";
  }
  for (std::size_t p = 0; p < attributes.patch_names.size(); ++p)
    bytes += std::string(kPatchComment) + std::to_string(p + 1) + " " + attributes.patch_names[p] + "\n";
  bytes += "element vertex " + std::to_string(vertices) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) bytes += std::string("property double ") + name + "\n";
  for (const auto& a : attributes.vertex) declare(bytes, a, word(a.name));
  bytes += "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
  for (const auto& a : attributes.face) declare(bytes, a, a.name == kSkewnessName ? "quality" : word(a.name));
  bytes += "end_header\n";
  return bytes;
}

void write_vertices(PlyBody body, std::span<const Vec3> positions, std::span<const Vec3> normals,
                    const std::vector<MeshAttribute>& attributes) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (const double x : positions[v]) body.add(x);
    for (const double x : normals[v]) body.add(x);
    for (const auto& a : attributes) body.add(a, v);
    body.end_row();
  }
}

void write_faces(PlyBody body, std::span<const Triangle> faces, const std::vector<MeshAttribute>& attributes) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    body.add(std::uint8_t{3});
    for (const Index v : faces[f]) body.add(static_cast<std::int32_t>(v));
    for (const auto& a : attributes) body.add(a, f);
    body.end_row();
  }
}

}  // namespace

void write_ply(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata, const SurfaceWriteOptions& options) {
  std::string bytes = header_of(mesh.vertices.size(), mesh.faces.size(), attributes, metadata, options.encoding);
  const PlyBody body(out, bytes, options.encoding);
  write_vertices(body, mesh.vertices, vertex_normals(mesh), attributes.vertex);
  write_faces(body, mesh.faces, attributes.face);
  write_out(out, bytes);
}

}  // namespace vmesh::io

namespace vmesh {
namespace {

void check_columns(const std::vector<MeshAttribute>& attributes, std::size_t declared, std::size_t count) {
  bool good = attributes.size() == declared;
  for (const MeshAttribute& a : attributes) good = good && a.values.size() == count;
  if (!good) throw InvalidInput("a block of a surface does not have the attributes that were declared");
}

}  // namespace

PlyStream::PlyStream(const std::filesystem::path& path, std::size_t vertices, std::size_t faces,
                     const MeshAttributes& declared, const SurfaceMetadata& metadata)
    : name_(path.string()),
      vertex_attributes_(declared.vertex.size()),
      face_attributes_(declared.face.size()),
      vertices_left_(vertices),
      faces_left_(faces) {
  if (vertices >= 0x80000000 || faces >= 0x80000000)
    throw InvalidInput(name_ + ": the surface has too many vertices or faces for its file format (2^31)");
  file_ = std::make_unique<AtomicFile>(path);
  bytes_ = io::header_of(vertices, faces, declared, metadata, SurfaceEncoding::usual);
}

PlyStream::~PlyStream() = default;

void PlyStream::add_vertices(std::span<const Vec3> positions, std::span<const Vec3> normals,
                             const std::vector<MeshAttribute>& attributes) {
  check_columns(attributes, vertex_attributes_, positions.size());
  if (normals.size() != positions.size() || positions.size() > vertices_left_)
    throw InvalidInput(name_ + ": more vertices than were declared, or normals for others");
  vertices_left_ -= positions.size();
  io::write_vertices({file_->stream(), bytes_, SurfaceEncoding::usual}, positions, normals, attributes);
}

void PlyStream::add_faces(std::span<const Triangle> faces, const std::vector<MeshAttribute>& attributes) {
  check_columns(attributes, face_attributes_, faces.size());
  if (vertices_left_ > 0 || faces.size() > faces_left_)
    throw InvalidInput(name_ + ": faces come after all vertices, no more than were declared");
  faces_left_ -= faces.size();
  io::write_faces({file_->stream(), bytes_, SurfaceEncoding::usual}, faces, attributes);
}

void PlyStream::commit() {
  if (vertices_left_ > 0 || faces_left_ > 0) throw InvalidInput(name_ + ": fewer vertices or faces than were declared");
  io::write_out(file_->stream(), bytes_);
  file_->commit();
}

}  // namespace vmesh
