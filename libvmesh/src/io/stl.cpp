#include <ostream>
#include <unordered_map>

#include "boundaries.h"
#include "bytes.h"
#include "formats.h"
#include "named_patches.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

constexpr std::size_t kHeaderSize = 80, kFacetSize = 50;

/// Gives equal positions one vertex.
class VertexJoiner {
 public:
  explicit VertexJoiner(std::vector<Vec3>& vertices) : vertices_(vertices) {}

  std::int64_t add(const Vec3& p) {
    const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // + 0.0: no negative zero
    const auto [place, is_new] = index_.try_emplace(key, static_cast<Index>(vertices_.size()));
    if (is_new) vertices_.emplace_back(key[0], key[1], key[2]);
    return place->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t h = 0;
      for (const double x : p) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdULL;
        h ^= h >> 32;
      }
      return h;
    }
  };

  std::vector<Vec3>& vertices_;
  std::unordered_map<std::array<double, 3>, Index, Hash> index_;
};

void check_finite(const Vec3& p, const std::string& place) {
  // Checked here, because NaN never equals itself and would defeat the joining.
  if (!p.allFinite()) throw InvalidInput(place + ": a corner is not finite (NaN or infinity)");
}

void parse_binary(std::string_view content, const std::string& source, LoadedSurface& surface, FaceCollector& faces) {
  const std::size_t count = load<std::uint32_t>(content.data() + kHeaderSize);
  const std::size_t room = (content.size() - kHeaderSize - 4) / kFacetSize;
  if (count > room) {
    throw InvalidInput(source + ": the header promises " + std::to_string(count) + " facets, the file has room for " +
                       std::to_string(room) + "; it is cut short or no STL file");
  }
  read_tags(content.substr(0, kHeaderSize), surface.unit, surface.space);
  VertexJoiner joiner(surface.mesh.vertices);
  std::vector<std::int64_t> corners(3);
  for (std::size_t f = 0; f < count; ++f) {
    const char* facet = content.data() + kHeaderSize + 4 + f * kFacetSize + 12;  // after the normal
    const std::string place = "facet " + std::to_string(f);
    for (std::size_t i = 0; i < 3; ++i) {
      const char* at = facet + 12 * i;
      const Vec3 p(load<float>(at), load<float>(at + 4), load<float>(at + 8));
      check_finite(p, source + ": " + place);
      corners[i] = joiner.add(p);
    }
    faces.add(corners, place);
  }
}

void parse_text(std::string_view content, const std::string& source, LoadedSurface& surface, FaceCollector& faces,
                FaceGroups& groups) {
  LineReader lines(content);
  VertexJoiner joiner(surface.mesh.vertices);
  std::vector<std::int64_t> corners;
  std::vector<std::string_view> fields;
  std::string_view line;
  const auto place = [&] { return "line " + std::to_string(lines.number()); };
  while (lines.next(line)) {
    split_blank(line, fields);
    if (fields.empty()) continue;
    const std::string word = lower(fields[0]);
    if (word == "solid" || word == "endsolid") read_tags(line, surface.unit, surface.space);
    if (word == "solid") groups.begin(fields.size() > 1 ? std::string(fields[1]) : std::string());
    if (word == "vertex") {
      Vec3 p;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto value = i + 1 < fields.size() ? parse_double(fields[i + 1]) : std::nullopt;
        if (!value) throw InvalidInput(source + ": " + place() + ": a vertex has three numbers");
        p[static_cast<Eigen::Index>(i)] = *value;
      }
      check_finite(p, source + ": " + place());
      corners.push_back(joiner.add(p));
    }
    if (word == "endloop" || word == "endfacet") {
      if (!corners.empty()) faces.add(corners, place()), groups.add_face();
      corners.clear();
    }
  }
}

/// Frame, unit and generator on one line.
std::string tags_of(const SurfaceMetadata& metadata) {
  return "SPACE=" + std::string(to_string(metadata.space)) + " UNIT=" + std::string(to_string(metadata.unit)) + " " +
         one_line(metadata.generator);
}

Vec3 facet_normal(const TriMesh& mesh, Index f) { return area_normal(mesh, f).normalized(); }

void write_binary(std::ostream& out, const TriMesh& mesh, const SurfaceMetadata& metadata) {
  std::string bytes = tags_of(metadata);
  bytes.resize(kHeaderSize, ' ');
  store(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    for (const double x : facet_normal(mesh, f)) store(bytes, static_cast<float>(x));
    for (const Index v : mesh.faces[f]) {
      for (const double x : mesh.vertices[v]) store(bytes, static_cast<float>(x));
    }
    store(bytes, std::uint16_t{0});
    write_blocks(out, bytes);
  }
  write_out(out, bytes);
}

/// "facet normal 0 0 1" or "vertex 1 2 3".
template <class Real>
void append_line(std::string& bytes, const char* words, const Vec3& p) {
  bytes += words;
  for (const double x : p) append(bytes += ' ', static_cast<Real>(x));
  bytes += '\n';
}

void append_facet(std::string& bytes, const TriMesh& mesh, Index f) {
  append_line<float>(bytes, "facet normal", facet_normal(mesh, f));
  bytes += "outer loop\n";
  for (const Index v : mesh.faces[f]) append_line<double>(bytes, "vertex", mesh.vertices[v]);
  bytes += "endloop\nendfacet\n";
}

void append_solid(std::ostream& out, std::string& bytes, const TriMesh& mesh, const Boundary& boundary) {
  bytes += "solid " + boundary.name + "\n";
  for (const Index f : boundary.faces) {
    append_facet(bytes, mesh, f);
    write_blocks(out, bytes);
  }
  bytes += "endsolid " + boundary.name + "\n";
}

/// The tags are at the end, as programs take what follows "solid" as the name of a boundary.
void write_text(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                const SurfaceMetadata& metadata) {
  std::string bytes;
  for (const Boundary& boundary : boundaries_of(mesh, attributes)) append_solid(out, bytes, mesh, boundary);
  bytes.back() = ' ';
  bytes += tags_of(metadata) + "\n";
  write_out(out, bytes);
}

}  // namespace

LoadedSurface parse_stl(std::string_view content, const std::string& source) {
  LoadedSurface surface;
  FaceCollector faces(surface, source);
  FaceGroups groups;
  const bool says_solid = lower(content.substr(0, 5)) == "solid";
  const bool has_header = content.size() >= kHeaderSize + 4;
  // Some binary files begin with "solid", too; their size gives them away.
  const bool exact =
      has_header &&
      content.size() == kHeaderSize + 4 + kFacetSize * std::size_t{load<std::uint32_t>(content.data() + kHeaderSize)};
  if (exact || (!says_solid && has_header)) {
    parse_binary(content, source, surface, faces);
  } else if (says_solid) {
    parse_text(content, source, surface, faces, groups);
  } else {
    throw InvalidInput(source + ": this is not an STL file: it neither begins with \"solid\" nor has a binary header");
  }
  faces.finish();
  groups.finish(surface, faces.face_of_triangle());
  return surface;
}

void write_stl(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
               const SurfaceMetadata& metadata, const SurfaceWriteOptions& options) {
  if (options.encoding == SurfaceEncoding::text) {
    write_text(out, mesh, attributes, metadata);
  } else {
    write_binary(out, mesh, metadata);
  }
}

}  // namespace vmesh::io
