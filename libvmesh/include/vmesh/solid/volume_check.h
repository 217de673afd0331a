#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmesh/mesh/volume_mesh.h"
#include "vmesh/solid/vessel_wall.h"

namespace vmesh {

/// What a sound volume mesh must not have.
enum class VolumeDefectKind {
  not_filled,      ///< the core could not be divided into tetrahedra
  inverted_cell,   ///< a tetrahedron or wedge without a positive volume everywhere
  not_conforming,  ///< cells that do not meet face to face, or boundary faces that are not those of one cell
  wrong_label,     ///< a region or patch that does not exist
  crossing_faces,  ///< boundary faces that cross others
  other_boundary   ///< volume or area of a cap is not that of the surface
};
std::string_view to_string(VolumeDefectKind kind);

/// One or more defects of a kind.
struct VolumeDefect {
  VolumeDefectKind kind = VolumeDefectKind::inverted_cell;
  Vec3 position = Vec3::Zero();  ///< of the first, mm
  std::size_t count = 0;
  std::string message;  ///< what, how many, where
};

/// Defects of any mesh, whoever made it, but for other_boundary. Tetrahedra and
/// pyramids are tested with exact predicates. A wedge is taken to be positive if all Bezier coefficients of the
/// determinant of its map are (sufficient).
std::vector<VolumeDefect> find_volume_defects(const VolumeMesh& mesh);

/// The cells among these defects: those that are flat or turned over somewhere. Count 0 if there are none. Throws
/// InvalidInput for cells with corners that do not exist.
VolumeDefect find_inverted_cells(const VolumeMesh& mesh);

/// Whether the cells of `region` fill what `wall` encloses: the volume and the areas of caps, which are equal but for
/// rounding and for what caps differ from planes. Empty if so.
std::vector<VolumeDefect> compare_with_wall(const VolumeMesh& mesh, std::string_view region, const VesselWall& wall);

/// Figures of a mesh.
struct VolumeMeasures {
  double min_dihedral_deg = 180, max_dihedral_deg = 0;  ///< of tetrahedra
  double least_radius_ratio = 1;                        ///< of tetrahedra: 3 inradius / circumradius, 1 if regular
  double mean_radius_ratio = 1;
  double least_scaled_jacobian = 1;  ///< of wedges: smallest Bezier coefficient by the largest
  std::vector<double> region_volume_mm3, patch_area_mm2;
  Vec3 worst_tetrahedron = Vec3::Zero();  ///< where min_dihedral_deg is
};
VolumeMeasures measure_volume(const VolumeMesh& mesh);

/// For every cell the least determinant of its map that find_volume_defects() looks at, in mm^3: six volumes of a
/// tetrahedron, the least of the four corners of a pyramid's base, the least Bezier coefficient of a wedge's. 0 or
/// less: flat or turned over somewhere, but for rounding.
std::vector<double> least_jacobians_mm3(const VolumeMesh& mesh);

/// Volumes of cells, mm^3.
double volume_of(const VolumeMesh& mesh, const Tetrahedron& cell);
double volume_of(const VolumeMesh& mesh, const Wedge& cell);
double volume_of(const VolumeMesh& mesh, const Pyramid& cell);

}  // namespace vmesh
