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

/// Face `face` of faces_of() of a cell.
struct CellSide {
  Index cell = kNone;
  Index face = 0;
};

/// The side of a cell that each face of the boundary is. Throws InvalidInput, naming the face, if it is no face of a
/// cell, of more than one, or seen from inside counter-clockwise.
std::vector<CellSide> sides_of_boundary(const VolumeMesh& mesh);

/// The boundary as a surface, quadrilaterals in two, with the points that it uses in their order.
struct BoundarySurface {
  TriMesh mesh;
  std::vector<Index> patch;  ///< of every face, in VolumeMesh::patch_names
};
BoundarySurface boundary_surface(const VolumeMesh& mesh);

/// The faces that belong to one cell alone, in the order of the cells.
std::vector<CellFace> outer_faces(const VolumeMesh& mesh);

/// A face between two cells.
struct InnerFace {
  CellFace corners;                        ///< counter-clockwise seen from `neighbour`
  Index owner = kNone, neighbour = kNone;  ///< cells, owner < neighbour
};

/// All of them, ascending in owner, then neighbour. Throws InvalidInput, naming a cell, where cells do not meet face to
/// face: a face of one cell that is not in the boundary, of more than two, or of two on the same side.
std::vector<InnerFace> inner_faces(const VolumeMesh& mesh);

/// Throws InvalidInput unless cells and faces name points, regions and patches that exist, every cell has a region, and
/// the names of regions and patches are unique and good for every format (check_patch_names()).
void check_volume_mesh(const VolumeMesh& mesh);

}  // namespace vmesh
