#pragma once

#include <array>

#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Corners of a cell's face, counter-clockwise seen from outside the cell; the last is kNone in a triangle.
using CellFace = std::array<Index, 4>;

inline std::array<CellFace, 4> faces_of(const Tetrahedron& cell) {
  const auto& [a, b, c, d] = cell;
  return {{{a, c, b, kNone}, {a, b, d, kNone}, {b, c, d, kNone}, {c, a, d, kNone}}};
}

inline std::array<CellFace, 5> faces_of(const Wedge& cell) {
  const auto& [a, b, c, d, e, f] = cell;
  return {{{a, c, b, kNone}, {d, e, f, kNone}, {a, b, e, d}, {b, c, f, e}, {c, a, d, f}}};
}

inline std::array<CellFace, 5> faces_of(const Pyramid& cell) {
  const auto& [a, b, c, d, e] = cell;
  return {{{a, d, c, b}, {a, b, e, kNone}, {b, c, e, kNone}, {c, d, e, kNone}, {d, a, e, kNone}}};
}

/// Calls visit(cell) for all cells, in their order.
template <class Visit>
void for_each_cell(const VolumeMesh& mesh, Visit&& visit) {
  for (const Tetrahedron& cell : mesh.tetrahedra) visit(cell);
  for (const Wedge& cell : mesh.wedges) visit(cell);
  for (const Pyramid& cell : mesh.pyramids) visit(cell);
}

}  // namespace vmesh
