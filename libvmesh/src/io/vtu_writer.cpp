// VTK's XML files of unstructured grids (VTK File Formats, "XML File Formats"), written.
#include <ostream>
#include <span>

#include "vmesh/mesh/volume_faces.h"

#include "formats.h"
#include "volume_files.h"
#include "vtk_xml_writer.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

constexpr int kVtkTriangle = 5, kVtkQuad = 9, kVtkTetra = 10, kVtkWedge = 13,
              kVtkPyramid = 14;  // vtkCellType.h

/// Calls `take` with the type of every cell of the file and its corners, in VTK's order.
template <class Take>
void for_each_grid_cell(const VolumeMesh& mesh, bool with_faces, const Take& take) {
  for (const Tetrahedron& t : mesh.tetrahedra) take(kVtkTetra, std::span<const Index>(t));
  for (const auto& [a, b, c, d, e, f] : mesh.wedges) {
    // vtkWedge: the normal of the base points away from the other triangle; ours points to it.
    const Wedge turned = {a, c, b, d, f, e};
    take(kVtkWedge, std::span<const Index>(turned));
  }
  for (const Pyramid& p : mesh.pyramids) take(kVtkPyramid, std::span<const Index>(p));
  if (!with_faces) return;
  for (const BoundaryFace& face : mesh.boundary) {
    const std::span<const Index> corners(face.corners);
    if (face.is_triangle()) {
      take(kVtkTriangle, corners.first(3));
    } else {
      take(kVtkQuad, corners);
    }
  }
}

void add_grid_cells(VtkXmlFile& file, const VolumeMesh& mesh, bool with_faces, std::size_t count) {
  file.open("Cells");
  file.add_array<std::int64_t>("Int64", "connectivity", 1, count, [&](const auto& add) {
    for_each_grid_cell(mesh, with_faces, [&](int, std::span<const Index> corners) {
      for (const Index v : corners) add(v);
    });
  });
  file.add_array<std::int64_t>("Int64", "offsets", 1, count, [&](const auto& add) {
    std::size_t end = 0;
    for_each_grid_cell(mesh, with_faces, [&](int, std::span<const Index> corners) { add(end += corners.size()); });
  });
  file.add_array<std::uint8_t>("UInt8", "types", 1, count, [&](const auto& add) {
    for_each_grid_cell(mesh, with_faces, [&](int type, std::span<const Index>) { add(type); });
  });
  file.close();
}

/// Numbers of cells, then of the cells behind faces.
template <class T>
std::vector<double> and_of_faces(const std::vector<T>& of_cells, const std::vector<CellSide>& behind,
                                 double offset = 0) {
  std::vector<double> values;
  values.reserve(of_cells.size() + behind.size());
  for (const T value : of_cells) values.push_back(value + offset);
  for (const CellSide& side : behind) values.push_back(of_cells[side.cell] + offset);
  return values;
}

std::vector<double> patch_numbers(const VolumeMesh& mesh) {
  std::vector<double> values(mesh.cell_count(), 0.0);
  for (const BoundaryFace& face : mesh.boundary) values.push_back(face.patch + 1.0);
  return values;
}

}  // namespace

void write_grid(std::ostream& out, const VolumeMesh& mesh, const std::vector<CellSide>& sides,
                const VolumeAttributes& attributes, const VolumeMetadata& metadata) {
  const bool with_faces = !sides.empty();
  const std::size_t count = mesh.cell_count() + sides.size();
  VtkXmlFile file("UnstructuredGrid");
  file.open("FieldData");
  file.add_texts("RegionNames", mesh.region_names);
  if (with_faces) file.add_texts("PatchNames", mesh.patch_names);
  add_metadata(file, metadata);
  file.close();
  file.open("Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
            std::to_string(count) + "\"");
  file.open("PointData");
  for (const MeshAttribute& a : attributes.point) file.add_numbers(to_vtk(kPointNames, a.name), a.values, a.integer);
  file.close();
  file.open("CellData Scalars=\"ModelRegionID\"");
  file.add_numbers("ModelRegionID", and_of_faces(mesh.cell_region, sides, 1), true);
  if (with_faces) file.add_numbers("ModelFaceID", patch_numbers(mesh), true);
  for (const MeshAttribute& a : attributes.cell)
    file.add_numbers(to_vtk(kCellNames, a.name), and_of_faces(a.values, sides), a.integer);
  file.close();
  file.add_points(mesh.points.size(), [&](std::size_t i) -> const Vec3& { return mesh.points[i]; });
  add_grid_cells(file, mesh, with_faces, count);
  file.write(out);
}

void write_volume_vtu(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes& attributes,
                      const VolumeMetadata& metadata) {
  write_grid(open(""), mesh, sides_of_boundary(mesh), attributes, metadata);
}

}  // namespace vmesh::io
