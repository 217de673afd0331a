#pragma once

#include <array>
#include <vector>

#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Corners of a face of a cell, counter-clockwise seen from outside the cell; of a triangle the last one is kNone.
using CellFace = std::array<Index, 4>;

std::array<CellFace, 4> faces_of(const Tetrahedron& cell);
/// The two triangles first.
std::array<CellFace, 5> faces_of(const Wedge& cell);
/// The quadrilateral first.
std::array<CellFace, 5> faces_of(const Pyramid& cell);

/// Calls visit(cell) for every cell, in the order of their numbers.
template <class Visit>
void for_each_cell(const VolumeMesh& mesh, const Visit& visit) {
  for (const Tetrahedron& cell : mesh.tetrahedra) visit(cell);
  for (const Wedge& cell : mesh.wedges) visit(cell);
  for (const Pyramid& cell : mesh.pyramids) visit(cell);
}

/// The number of the cell to which each face of the boundary belongs. Throws InvalidInput, naming the face, if it is no
/// face of a cell, of more than one, or seen from inside counter-clockwise.
std::vector<Index> cells_behind_boundary(const VolumeMesh& mesh);

/// Throws InvalidInput unless cells and faces name points, regions and patches that exist, every cell has a region, and
/// the names of regions and patches are unique, not empty and on one line.
void check_volume_mesh(const VolumeMesh& mesh);

}  // namespace vmesh
