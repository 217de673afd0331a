// Gmsh's files in text, MSH 2.2 and 4.1 (C. Geuzaine, J.-F. Remacle, Gmsh Reference Manual, section "File formats").
#include <array>
#include <map>
#include <span>

#include "vmesh/mesh/volume_faces.h"

#include "comments.h"
#include "formats.h"
#include "text_rows.h"

namespace vmesh::io {
namespace {

constexpr int kGmshTriangle = 2, kGmshQuad = 3, kGmshTetrahedron = 4, kGmshPrism = 6, kGmshPyramid = 7;

/// A physical group or an entity: patches from 1, then regions, so that their numbers differ also for programs that do
/// not look at the dimension.
Index number_of_region(const VolumeMesh& mesh, Index region) {
  return static_cast<Index>(mesh.patch_names.size()) + region + 1;
}

/// Calls `take` with dimension, group, type and corners of all faces, then of all cells.
template <class Take>
void for_each_element(const VolumeMesh& mesh, const Take& take) {
  for (const BoundaryFace& face : mesh.boundary) {
    const bool is_triangle = face.is_triangle();
    take(2, face.patch + 1, is_triangle ? kGmshTriangle : kGmshQuad,
         std::span<const Index>(face.corners).first(is_triangle ? 3 : 4));
  }
  Index cell = 0;
  for_each_cell(mesh, [&](const auto& corners) {
    const int type = corners.size() == 4 ? kGmshTetrahedron : corners.size() == 6 ? kGmshPrism : kGmshPyramid;
    take(3, number_of_region(mesh, mesh.cell_region[cell++]), type, std::span<const Index>(corners));
  });
}

void add_head(TextRows& rows, const char* version, const VolumeMesh& mesh, const VolumeMetadata& metadata) {
  rows.line("$MeshFormat");
  rows.row(version, 0, 8);  // text, size of a double
  rows.line("$EndMeshFormat\n$Comments");
  rows.line(comments(metadata, "") + "$EndComments\n$PhysicalNames");
  rows.row(mesh.patch_names.size() + mesh.region_names.size());
  for (Index p = 0; p < mesh.patch_names.size(); ++p) rows.row(2, p + 1, '"' + mesh.patch_names[p] + '"');
  for (Index r = 0; r < mesh.region_names.size(); ++r)
    rows.row(3, number_of_region(mesh, r), '"' + mesh.region_names[r] + '"');
  rows.line("$EndPhysicalNames");
}

void add_corners(TextRows& rows, std::span<const Index> corners) {
  for (const Index v : corners) rows.add(v + 1);
  rows.end_row();
}

/// What Gmsh calls an entity: a patch (dimension 2) or a region (3).
using Entity = std::pair<int, Index>;

struct EntityContent {
  Eigen::AlignedBox3d box;
  std::vector<Index> points;                             ///< that belong to no entity before it
  std::map<int, std::vector<std::vector<Index>>> cells;  ///< by type
};

std::map<Entity, EntityContent> entities_of(const VolumeMesh& mesh) {
  std::map<Entity, EntityContent> entities;
  for (Index p = 0; p < mesh.patch_names.size(); ++p) entities[{2, p + 1}];
  for (Index r = 0; r < mesh.region_names.size(); ++r) entities[{3, number_of_region(mesh, r)}];
  std::vector<bool> taken(mesh.points.size(), false);
  for_each_element(mesh, [&](int dimension, Index group, int type, std::span<const Index> corners) {
    EntityContent& entity = entities[{dimension, group}];
    entity.cells[type].emplace_back(corners.begin(), corners.end());
    for (const Index v : corners) {
      entity.box.extend(mesh.points[v]);
      if (!taken[v]) entity.points.push_back(v);
      taken[v] = true;
    }
  });
  for (Index v = 0; v < taken.size(); ++v) {
    if (!taken[v]) entities.rbegin()->second.points.push_back(v);
  }
  return entities;
}

void add_entities(TextRows& rows, const VolumeMesh& mesh, const std::map<Entity, EntityContent>& entities) {
  rows.line("$Entities");
  rows.row(0, 0, mesh.patch_names.size(), mesh.region_names.size());
  for (const auto& [entity, content] : entities) {
    const bool is_empty = content.box.isEmpty();
    rows.add(entity.second);
    rows.add(is_empty ? Vec3(0, 0, 0) : content.box.min());
    rows.add(is_empty ? Vec3(0, 0, 0) : content.box.max());
    rows.row(1, entity.second, 0);  // its physical group; what bounds it is not told
  }
  rows.line("$EndEntities");
}

}  // namespace

void write_gmsh_2(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes&,
                  const VolumeMetadata& metadata) {
  TextRows rows(open(""));
  add_head(rows, "2.2", mesh, metadata);
  rows.line("$Nodes");
  rows.row(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) rows.row(i + 1, mesh.points[i]);
  rows.line("$EndNodes\n$Elements");
  rows.row(mesh.boundary.size() + mesh.cell_count());
  std::size_t element = 0;
  for_each_element(mesh, [&](int, Index group, int type, std::span<const Index> corners) {
    rows.add(++element);
    rows.add(type);
    rows.add(2);  // tags: the physical group and the entity
    rows.add(group);
    rows.add(group);
    add_corners(rows, corners);
  });
  rows.line("$EndElements");
}

void write_gmsh_4(const VolumeFormat::OpenFile& open, const VolumeMesh& mesh, const VolumeAttributes&,
                  const VolumeMetadata& metadata) {
  TextRows rows(open(""));
  const std::map<Entity, EntityContent> entities = entities_of(mesh);
  add_head(rows, "4.1", mesh, metadata);
  add_entities(rows, mesh, entities);
  rows.line("$Nodes");
  rows.row(entities.size(), mesh.points.size(), 1, mesh.points.size());
  std::size_t blocks = 0;
  for (const auto& [entity, content] : entities) {
    rows.row(entity.first, entity.second, 0, content.points.size());
    for (const Index v : content.points) rows.row(v + 1);
    for (const Index v : content.points) rows.row(mesh.points[v]);
    blocks += content.cells.size();
  }
  rows.line("$EndNodes\n$Elements");
  const std::size_t count = mesh.boundary.size() + mesh.cell_count();
  rows.row(blocks, count, 1, count);
  std::size_t element = 0;
  for (const auto& [entity, content] : entities) {
    for (const auto& [type, cells] : content.cells) {
      rows.row(entity.first, entity.second, type, cells.size());
      for (const std::vector<Index>& corners : cells) {
        rows.add(++element);
        add_corners(rows, corners);
      }
    }
  }
  rows.line("$EndElements");
}

}  // namespace vmesh::io
