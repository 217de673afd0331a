#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Corners a, b, c, d with d on the side that the normal of (a, b, c) points to: (b - a) x (c - a) . (d - a) > 0.
using Tetrahedron = std::array<Index, 4>;
/// A prism over a triangle: corners a, b, c and over them d, e, f, on the side that the normal of (a, b, c) points to.
using Wedge = std::array<Index, 6>;
/// Over a quadrilateral a, b, c, d, the corner e on the side that its normal points to, (a, b, c, d) being
/// counter-clockwise about it.
using Pyramid = std::array<Index, 5>;

/// A face of a cell that no other cell has, on the outside of a volume mesh.
struct BoundaryFace {
  std::array<Index, 4> corners = {kNone, kNone, kNone, kNone};  ///< counter-clockwise seen from outside
  Index patch = 0;                                              ///< in VolumeMesh::patch_names

  bool is_triangle() const { return corners[3] == kNone; }
};

/// A mesh of cells that meet face to face. They are numbered tetrahedra first, then wedges, then pyramids. Positions in
/// mm.
struct VolumeMesh {
  std::vector<Vec3> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Wedge> wedges;
  std::vector<Pyramid> pyramids;          ///< few: where layers of wedges end
  std::vector<Index> cell_region;         ///< per cell, in region_names
  std::vector<BoundaryFace> boundary;     ///< all of it
  std::vector<std::string> region_names;  ///< "lumen", "wall" ...
  std::vector<std::string> patch_names;   ///< "wall", "cap_1" ...

  std::size_t cell_count() const { return tetrahedra.size() + wedges.size() + pyramids.size(); }
};

/// The attributes of a volume mesh in files, in file order.
struct VolumeAttributes {
  std::vector<MeshAttribute> point;  ///< each as long as VolumeMesh::points
  std::vector<MeshAttribute> cell;   ///< each as long as VolumeMesh::cell_count()
};

}  // namespace vmesh
