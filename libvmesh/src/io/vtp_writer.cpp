// VTK's XML files of polygonal data (VTK File Formats, "XML File Formats"), written.
#include <ostream>

#include "end_section_arrays.h"
#include "formats.h"
#include "vtk_xml_writer.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

std::string piece(std::size_t points, std::size_t verts, std::size_t lines, std::size_t polys) {
  return "Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=\"" + std::to_string(verts) +
         "\" NumberOfLines=\"" + std::to_string(lines) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(polys) + "\"";
}

/// The attribute by which a viewer colours initially.
std::string scalars(const std::vector<MeshAttribute>& attributes, const auto& names) {
  return attributes.empty() ? "" : " Scalars=\"" + vtk_escaped(to_vtk(names, attributes.front().name)) + "\"";
}

}  // namespace

void write_centerline_vtp(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                          const std::vector<EndSection>& sections) {
  const auto& nodes = centerline.nodes();
  std::vector<Index> isolated;
  for (Index n = 0; n < nodes.size(); ++n)
    if (centerline.degree(n) == 0) isolated.push_back(n);
  VtkXmlFile file("PolyData");
  file.open("FieldData");
  for (const FieldArray& array : end_section_arrays(sections))
    file.add_numbers(array.name, array.values, array.integer, array.components);
  add_metadata(file, metadata);
  file.close();
  file.open(piece(nodes.size(), isolated.size(), centerline.segments().size(), 0));
  file.open("PointData");
  std::vector<double> radius;
  for (const CenterlineNode& node : nodes) radius.push_back(node.radius);
  file.add_numbers("MaximumInscribedSphereRadius", radius, false);
  file.close();
  file.open("CellData");
  if (!metadata.segment_labels.empty()) {
    std::vector<double> labels(isolated.size(), -1);  // cells before the lines
    labels.insert(labels.end(), metadata.segment_labels.begin(), metadata.segment_labels.end());
    file.add_numbers("Label", labels, false);
  }
  file.close();
  file.add_points(nodes.size(), [&](std::size_t i) -> const Vec3& { return nodes[i].position; });
  file.add_cells("Verts", isolated.size(), 1, [&](const auto& take) {
    for (const Index n : isolated) take(n);
  });
  file.add_cells("Lines", centerline.segments().size(), 2, [&](const auto& take) {
    for (const auto& [a, b] : centerline.segments()) take(a), take(b);
  });
  file.write(out);
}

void write_surface_vtp(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                       const SurfaceMetadata& metadata, const SurfaceWriteOptions&) {
  VtkXmlFile file("PolyData");
  file.open("FieldData");
  if (!attributes.patch_names.empty()) file.add_texts("PatchNames", attributes.patch_names);
  add_metadata(file, metadata);
  file.close();
  file.open(piece(mesh.vertices.size(), 0, 0, mesh.faces.size()));
  file.open("PointData" + scalars(attributes.vertex, kPointNames) + " Normals=\"Normals\"");
  file.add_array<float>("Float32", "Normals", 3, mesh.vertices.size(), [&](const auto& take) {
    for (const Vec3& normal : vertex_normals(mesh))
      for (const double x : normal) take(x);
  });
  for (const MeshAttribute& a : attributes.vertex) file.add_numbers(to_vtk(kPointNames, a.name), a.values, a.integer);
  file.close();
  file.open("CellData" + scalars(attributes.face, kCellNames));
  for (const MeshAttribute& a : attributes.face) file.add_numbers(to_vtk(kCellNames, a.name), a.values, a.integer);
  file.close();
  file.add_points(mesh.vertices.size(), [&](std::size_t i) -> const Vec3& { return mesh.vertices[i]; });
  file.add_cells("Polys", mesh.faces.size(), 3, [&](const auto& take) {
    for (const Triangle& face : mesh.faces)
      for (const Index v : face) take(v);
  });
  file.write(out);
}

}  // namespace vmesh::io
