// TetGen's files (H. Si, TetGen: A Quality Tetrahedral Mesh Generator, version 1.5, User's Manual, section 5).
#include "vmesh/mesh/volume_faces.h"

#include "boundaries.h"
#include "comments.h"
#include "formats.h"
#include "text_rows.h"

namespace vmesh::io {
namespace {

/// What the numbers of regions or patches mean.
void add_names(TextRows& rows, const char* word, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    rows.line("# " + std::string(word) + " " + std::to_string(i + 1) + ": " + names[i]);
}

void write_nodes(TextRows& rows, const std::vector<Vec3>& points) {
  rows.row(points.size(), 3, 0, 0);  // dimensions, attributes, markers
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(i, points[i]);
}

}  // namespace

void write_tetgen(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes&,
                  const VolumeMetadata& metadata) {
  {
    TextRows rows(open(".node"));
    write_nodes(rows, mesh.points);
    rows.line(comments(metadata, "# "));
  }
  {
    TextRows rows(open(".ele"));
    rows.row(mesh.tetrahedra.size(), 4, 1);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto& [a, b, c, d] = mesh.tetrahedra[t];
      rows.row(t, a, b, c, d, mesh.cell_region[t] + 1);
    }
    add_names(rows, "region", mesh.region_names);
  }
  TextRows rows(open(".face"));
  rows.row(mesh.boundary.size(), 1);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    const auto& [a, b, c, none] = mesh.boundary[f].corners;
    rows.row(f, a, b, c, mesh.boundary[f].patch + 1);
  }
  add_names(rows, "patch", mesh.patch_names);
}

void write_smesh(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                 const SurfaceMetadata& metadata, const SurfaceWriteOptions&) {
  TextRows rows(out);
  rows.line(comments(metadata, "# "));
  write_nodes(rows, mesh.vertices);
  rows.row(mesh.faces.size(), 1);
  const std::vector<Boundary> boundaries = boundaries_of(mesh, attributes);
  std::vector<Index> marker(mesh.faces.size());
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    for (const Index f : boundaries[b].faces) marker[f] = static_cast<Index>(b + 1);
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    rows.row(3, a, b, c, marker[f]);
  }
  rows.line("0\n0");  // holes, regions
  for (std::size_t b = 0; b < boundaries.size(); ++b)
    rows.line("# patch " + std::to_string(b + 1) + ": " + boundaries[b].name);
}

}  // namespace vmesh::io
