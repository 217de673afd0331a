// From whatever triangle surface there is to closed volumes, internal to the module.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// A flat end of a vessel: an opening that was closed, or a flat cap that the wall had.
struct FlatWallEnd {
  Vec3 center = Vec3::Zero();  ///< centroid of the area, mm
  Vec3 normal = Vec3::Zero();  ///< unit, out of the vessel
  double area = 0;             ///< within the ring, projected along the normal, mm^2
  std::vector<Vec3> ring;      ///< the boundary in order, counter-clockwise about the normal, mm
  bool was_open = false;
  std::size_t part = 0;  ///< in ClosedWall::parts
};

/// A closed, manifold, oriented, outward-facing surface in one piece. Coincident vertices are possible, where it
/// touches itself, and so are faces without area and faces that cross others.
struct WallPart {
  TriMesh mesh;
  double volume = 0;               ///< mm^3, positive
  std::vector<Index> end_of_face;  ///< the end that a face belongs to, in ClosedWall::ends; kNone: to no end
  std::vector<bool> is_filling;    ///< of every face: it closes an opening, a slit or a pinhole, and is no wall
  bool wrapped = false;            ///< the faces are those of a wrap, not the surface's own

  /// Whether a face is vessel wall, neither part of an end nor a filling.
  bool is_wall(Index face) const { return end_of_face[face] == kNone && !is_filling[face]; }
};

struct ClosedWall {
  std::vector<WallPart> parts;     ///< largest volume first, at least one
  std::vector<FlatWallEnd> ends;   ///< by part; in a part, openings first
  std::vector<std::string> notes;  ///< what was done to the surface, for a user, a line each
  /// mm by which the wraps of unsound surfaces lay outside; their vertices were moved back onto the surface. 0: none.
  double wrap_offset = 0;
};

/// The volumes within a surface of any kind:
/// - equal vertices become one; so do those at boundaries within a millionth of the extent, or at most a tenth of the
///   median edge, as far as that closes edges; faces without corners of their own, duplicates and fins are left out;
/// - faces are turned to face the same side as their neighbours, and outwards;
/// - openings are closed; those that are ends of vessels are remembered: round, no more uneven than half their radius,
///   with at least a tenth of the cross-section behind them; slits, pinholes and others are only noted;
/// - flat caps that a wall has are found, but for those of contours of masks that are stairs;
/// - of a shell within a shell, the inner is taken if it has at least a quarter of the volume (a wall with a thickness:
///   the inner is the lumen), else left out as a cavity; components with almost no volume are left out;
/// - what has no sides (soups, edges with three faces, sheets) is wrapped (CGAL's alpha wrap).
/// Deterministic. Throws InvalidInput, saying what to do, for a surface without faces, area or volume, with positions
/// that are no numbers, and when a face names a vertex that does not exist; Cancelled.
ClosedWall close_wall(const TriMesh& surface, const Progress& progress = {});

}  // namespace vmesh::skeleton
