// Input files of Abaqus and CalculiX (G. Dhondt, CalculiX CrunchiX USER'S MANUAL, "Input deck format").
#include <algorithm>

#include "vmesh/core/text.h"
#include "vmesh/mesh/volume_faces.h"

#include "comments.h"
#include "formats.h"
#include "text_rows.h"

namespace vmesh::io {
namespace {

/// Both programs read at most 20 characters of a number.
std::string short_number(double x) { return formatted("%.13g", x); }

template <class Cell>
void add_elements(TextRows& rows, const VolumeMesh& mesh, const std::vector<Cell>& cells, Index first, Index region,
                  const char* type) {
  bool is_begun = false;
  for (Index c = 0; c < cells.size(); ++c) {
    if (mesh.cell_region[first + c] != region) continue;
    if (!is_begun) rows.line(std::string("*ELEMENT, TYPE=") + type + ", ELSET=" + mesh.region_names[region]);
    is_begun = true;
    rows.add(first + c + 1);
    for (const Index v : cells[c]) rows.add(v + 1);
    rows.end_row();
  }
}

/// Numbers from 1, as many to a line as a data line may have.
void add_members(TextRows& rows, const std::vector<Index>& numbers) {
  constexpr std::size_t kMost = 16;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    rows.add(numbers[i] + 1);
    if (i % kMost == kMost - 1 || i + 1 == numbers.size()) rows.end_row();
  }
}

std::vector<Index> points_of_patch(const VolumeMesh& mesh, Index patch) {
  std::vector<Index> points;
  for (const BoundaryFace& face : mesh.boundary) {
    if (face.patch != patch) continue;
    points.insert(points.end(), face.corners.begin(), face.corners.begin() + (face.is_triangle() ? 3 : 4));
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

void write_abaqus(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes&,
                  const VolumeMetadata& metadata) {
  const std::vector<CellSide> sides = sides_of_boundary(mesh);
  TextRows rows(open(""), ", ");
  rows.line(comments(metadata, "** ") + "*NODE");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    rows.add(i + 1);
    for (const double x : mesh.points[i]) rows.add(short_number(x));
    rows.end_row();
  }
  for (Index region = 0; region < mesh.region_names.size(); ++region) {
    add_elements(rows, mesh, mesh.tetrahedra, 0, region, "C3D4");
    add_elements(rows, mesh, mesh.wedges, static_cast<Index>(mesh.tetrahedra.size()), region, "C3D6");
  }
  for (Index patch = 0; patch < mesh.patch_names.size(); ++patch) {
    const std::vector<Index> points = points_of_patch(mesh, patch);
    if (points.empty()) continue;
    rows.line("*NSET, NSET=" + mesh.patch_names[patch]);
    add_members(rows, points);
    rows.line("*SURFACE, NAME=" + mesh.patch_names[patch] + ", TYPE=ELEMENT");
    for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
      // The faces of both elements are numbered as those of faces_of() are.
      if (mesh.boundary[f].patch == patch) rows.row(sides[f].cell + 1, "S" + std::to_string(sides[f].face + 1));
    }
  }
}

}  // namespace vmesh::io
