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

}  // namespace vmesh
