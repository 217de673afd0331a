// OpenFOAM's polyMesh folder in text (OpenFOAM User Guide, section "Mesh description").
#include <algorithm>
#include <array>

#include "vmesh/mesh/patch_names.h"
#include "vmesh/mesh/volume_faces.h"

#include "comments.h"
#include "formats.h"
#include "text_rows.h"
#include "volume_files.h"

namespace vmesh::io {
namespace {

/// One file: its head, then a list of `count` entries in brackets.
class FoamFile {
 public:
  FoamFile(std::ostream& out, const char* type, const char* object, const std::string& note, std::size_t count)
      : rows_(out) {
    rows_.line(std::string("FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       ") + type + ";");
    if (!note.empty()) rows_.line("    note        \"" + note + "\";");
    rows_.line(std::string("    location    \"constant/polyMesh\";\n    object      ") + object + ";\n}\n");
    rows_.row(count);
    rows_.line("(");
  }
  ~FoamFile() { rows_.line(")"); }
  FoamFile(const FoamFile&) = delete;
  FoamFile& operator=(const FoamFile&) = delete;

  TextRows& rows() { return rows_; }

 private:
  TextRows rows_;
};

std::string bracketed(const CellFace& corners) {
  std::string text = corners[3] == kNone ? "3(" : "4(";
  for (const Index v : corners) {
    if (v != kNone) text.append(std::to_string(v)).append(" ");
  }
  text.back() = ')';
  return text;
}

std::string bracketed(const Vec3& p) {
  std::string text = "(";
  for (const double x : p) append(text, x), text += ' ';
  text.back() = ')';
  return text;
}

/// Faces of the boundary, patch by patch.
std::vector<Index> faces_by_patch(const VolumeMesh& mesh) {
  std::vector<Index> order(mesh.boundary.size());
  for (Index f = 0; f < order.size(); ++f) order[f] = f;
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return mesh.boundary[a].patch < mesh.boundary[b].patch; });
  return order;
}

void write_patches(std::ostream& out, const VolumeMesh& mesh, std::size_t first_face) {
  FoamFile file(out, "polyBoundaryMesh", "boundary", "", mesh.patch_names.size());
  for (Index p = 0; p < mesh.patch_names.size(); ++p) {
    const auto count = std::count_if(mesh.boundary.begin(), mesh.boundary.end(),
                                     [&](const BoundaryFace& face) { return face.patch == p; });
    file.rows().line("    " + mesh.patch_names[p] + "\n    {");
    file.rows().line(std::string("        type        ") + (is_wall_name(mesh.patch_names[p]) ? "wall" : "patch") +
                     ";");
    file.rows().line("        nFaces      " + std::to_string(count) + ";");
    file.rows().line("        startFace   " + std::to_string(first_face) + ";\n    }");
    first_face += static_cast<std::size_t>(count);
  }
}

void write_zones(std::ostream& out, const VolumeMesh& mesh) {
  FoamFile file(out, "regIOobject", "cellZones", "", mesh.region_names.size());
  for (Index r = 0; r < mesh.region_names.size(); ++r) {
    file.rows().line("    " + mesh.region_names[r] + "\n    {\n        type        cellZone;");
    file.rows().line("        cellLabels  List<label>");
    file.rows().row(std::count(mesh.cell_region.begin(), mesh.cell_region.end(), r));
    file.rows().line("(");
    for (Index c = 0; c < mesh.cell_region.size(); ++c) {
      if (mesh.cell_region[c] == r) file.rows().row(c);
    }
    file.rows().line(");\n    }");
  }
}

}  // namespace

bool is_openfoam_file(std::string_view name) {
  constexpr std::array<std::string_view, 6> kNames = {"points", "faces", "owner", "neighbour", "boundary", "cellZones"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

void write_openfoam(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes&,
                    const VolumeMetadata& metadata) {
  const std::vector<InnerFace> inner = inner_faces(mesh);
  const std::vector<CellSide> sides = sides_of_boundary(mesh);
  const std::vector<Index> outer = faces_by_patch(mesh);
  const std::size_t face_count = inner.size() + outer.size();
  {
    std::string note = comments(metadata, "");
    std::replace(note.begin(), note.end(), '\n', ' ');
    std::replace(note.begin(), note.end(), '"', '\'');
    FoamFile file(open("points"), "vectorField", "points", note, mesh.points.size());
    for (const Vec3& p : mesh.points) file.rows().line(bracketed(p));
  }
  {
    FoamFile file(open("faces"), "faceList", "faces", "", face_count);
    for (const InnerFace& face : inner) file.rows().row(bracketed(face.corners));
    for (const Index f : outer) file.rows().row(bracketed(mesh.boundary[f].corners));
  }
  // Some of OpenFOAM's programs read the sizes from here.
  const std::string note = "nPoints: " + std::to_string(mesh.points.size()) +
                           " nCells: " + std::to_string(mesh.cell_count()) + " nFaces: " + std::to_string(face_count) +
                           " nInternalFaces: " + std::to_string(inner.size());
  {
    FoamFile file(open("owner"), "labelList", "owner", note, face_count);
    for (const InnerFace& face : inner) file.rows().row(face.owner);
    for (const Index f : outer) file.rows().row(sides[f].cell);
  }
  {
    FoamFile file(open("neighbour"), "labelList", "neighbour", note, inner.size());
    for (const InnerFace& face : inner) file.rows().row(face.neighbour);
  }
  write_patches(open("boundary"), mesh, inner.size());
  if (mesh.region_names.size() > 1) write_zones(open("cellZones"), mesh);
}

}  // namespace vmesh::io
