#include <algorithm>
#include <ostream>

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

void store_value(std::string& bytes, const MeshAttribute& attribute, std::size_t i) {
  if (is_color(attribute)) {
    store(bytes, static_cast<std::uint8_t>(std::clamp(attribute.values[i], 0.0, 255.0)));
  } else if (attribute.integer) {
    store(bytes, static_cast<std::int32_t>(attribute.values[i]));
  } else {
    store(bytes, attribute.values[i]);
  }
}

/// PLY names are single words.
std::string word(const std::string& name) {
  std::string result = one_line(name);
  for (char& c : result) {
    if (c == ' ') c = '_';
  }
  return result;
}

}  // namespace

void write_ply(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + comments(metadata, "comment ");
  for (const auto& a : attributes.face) {
    if (a.name == kSkewnessName) bytes += std::string(kSkewnessComment) + "\n";
  }
  bytes += "element vertex " + std::to_string(mesh.vertices.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) bytes += std::string("property double ") + name + "\n";
  for (const auto& a : attributes.vertex) declare(bytes, a, word(a.name));
  bytes += "element face " + std::to_string(mesh.faces.size()) + "\nproperty list uchar int vertex_indices\n";
  for (const auto& a : attributes.face) declare(bytes, a, a.name == kSkewnessName ? "quality" : word(a.name));
  bytes += "end_header\n";
  const auto normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (const double x : mesh.vertices[v]) store(bytes, x);
    for (const double x : normals[v]) store(bytes, x);
    for (const auto& a : attributes.vertex) store_value(bytes, a, v);
    write_blocks(out, bytes);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    store(bytes, std::uint8_t{3});
    for (const Index v : mesh.faces[f]) store(bytes, static_cast<std::int32_t>(v));
    for (const auto& a : attributes.face) store_value(bytes, a, f);
    write_blocks(out, bytes);
  }
  write_out(out, bytes);
}

}  // namespace vmesh::io
