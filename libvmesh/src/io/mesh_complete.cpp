// SimVascular's folder of a mesh for its solver (SimVascular documentation, "Mesh: exporting"; svSolver's svPre).
#include <algorithm>
#include <functional>

#include "vmesh/mesh/patch_names.h"
#include "vmesh/mesh/volume_faces.h"

#include "formats.h"
#include "volume_files.h"

namespace vmesh::io {
namespace {

constexpr std::string_view kSurfaces = "mesh-surfaces/";

MeshAttribute global_numbers(const char* name, std::size_t count) {
  MeshAttribute numbers{name, {}, true};
  for (std::size_t i = 0; i < count; ++i) numbers.values.push_back(static_cast<double>(i + 1));
  return numbers;
}

/// Faces of the boundary as a surface of its own, with the numbers of their points and cells in the volume.
struct FaceSelection {
  TriMesh mesh;
  MeshAttributes attributes;
};

FaceSelection select_faces(const VolumeMesh& mesh, const std::vector<CellSide>& sides,
                           const std::vector<MeshAttribute>& of_points,
                           const std::function<bool(Index patch)>& wanted) {
  FaceSelection selection;
  MeshAttribute node{"GlobalNodeID", {}, true}, element{"GlobalElementID", {}, true};
  MeshAttribute face_id{"ModelFaceID", {}, true}, region{"ModelRegionID", {}, true};
  std::vector<Index> points, number(mesh.points.size(), kNone);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f) {
    const BoundaryFace& face = mesh.boundary[f];
    if (!wanted(face.patch)) continue;
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      Index& of_point = number[face.corners[i]];
      if (of_point == kNone) {
        of_point = static_cast<Index>(points.size());
        points.push_back(face.corners[i]);
      }
      triangle[i] = of_point;
    }
    selection.mesh.faces.push_back(triangle);
    element.values.push_back(sides[f].cell + 1.0);
    face_id.values.push_back(face.patch + 1.0);
    region.values.push_back(mesh.cell_region[sides[f].cell] + 1.0);
  }
  for (const Index p : points) {
    selection.mesh.vertices.push_back(mesh.points[p]);
    node.values.push_back(p + 1.0);
  }
  selection.attributes.vertex.push_back(std::move(node));
  for (const MeshAttribute& all : of_points) {
    MeshAttribute some{all.name, {}, all.integer};
    for (const Index p : points) some.values.push_back(all.values[p]);
    selection.attributes.vertex.push_back(std::move(some));
  }
  selection.attributes.face = {std::move(face_id), std::move(element), std::move(region)};
  return selection;
}

}  // namespace

bool is_mesh_complete_file(std::string_view name) {
  return name == "mesh-complete.mesh.vtu" || name == "mesh-complete.exterior.vtp" || name == "walls_combined.vtp" ||
         (name.starts_with(kSurfaces) && name.ends_with(".vtp"));
}

void write_mesh_complete(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes& attributes,
                         const VolumeMetadata& metadata) {
  const std::vector<CellSide> sides = sides_of_boundary(mesh);
  const SurfaceMetadata of_faces = {metadata.generator,    metadata.options, metadata.input_name,
                                    metadata.input_sha256, metadata.unit,    metadata.space};
  VolumeAttributes numbered = attributes;
  numbered.point.insert(numbered.point.begin(), global_numbers("GlobalNodeID", mesh.points.size()));
  numbered.cell.insert(numbered.cell.begin(), global_numbers("GlobalElementID", mesh.cell_count()));
  write_grid(open("mesh-complete.mesh.vtu"), mesh, {}, numbered, metadata);
  const auto write_faces = [&](const std::string& name, const std::vector<MeshAttribute>& of_points,
                               const std::function<bool(Index)>& wanted) {
    const FaceSelection selection = select_faces(mesh, sides, of_points, wanted);
    write_surface_vtp(open(name), selection.mesh, selection.attributes, of_faces, {});
  };
  write_faces("mesh-complete.exterior.vtp", attributes.point, [](Index) { return true; });
  write_faces("walls_combined.vtp", {}, [&](Index patch) { return is_wall_name(mesh.patch_names[patch]); });
  for (Index p = 0; p < mesh.patch_names.size(); ++p)
    write_faces(std::string(kSurfaces) + mesh.patch_names[p] + ".vtp", {}, [&](Index patch) { return patch == p; });
}

}  // namespace vmesh::io
