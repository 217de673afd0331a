// Openings of a wall and what closes them, internal to the module.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "closed_wall.h"

namespace vmesh::skeleton {

/// A piece of a wall with the ends that it has; WallPart::end_of_face and FlatWallEnd::part are by the piece.
struct Shell {
  WallPart part;
  std::vector<FlatWallEnd> ends;
  bool was_inward = false;
  double largest_opening = 0;  ///< projected area of the largest ring that was closed, mm^2
};

/// What was closed, over all shells.
struct OpeningsClosed {
  std::size_t ends = 0, holes = 0, uneven = 0;  ///< ends; slits and pinholes; others that are far from flat
  double smallest_end = 0, largest_end = 0;     ///< mm^2
  double largest_hole = 0;                      ///< mm^2
  Vec3 hole_at = Vec3::Zero(), uneven_at = Vec3::Zero();

  std::vector<std::string> notes() const;
};

/// A shell of a sound mesh, outward if it encloses a volume. Every boundary loop is closed: by the Delaunay
/// triangulation of a flat one, by CGAL's hole filling of another, by a star where these would run into the surface.
Shell closed_shell(TriMesh mesh, OpeningsClosed& closed);

/// The same for a mesh whose faces have no sides: those of its boundaries that are simple loops are closed; the result
/// has no volume. What is the outside of its ends follows from where the wall is.
Shell closed_soup(TriMesh mesh, OpeningsClosed& closed);

}  // namespace vmesh::skeleton
