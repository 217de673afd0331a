#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// The surface where the trilinear interpolant of the 8 values at a cell's corners is zero, as triangles.
///
/// Corner x + 2 y + 4 z lies at (x, y, z), each 0 or 1. Edge 4 a + n runs along axis a; n counts the edge's position
/// along the other two axes, the lower one first: edge 4 + 3 is that along y at x = 1, z = 1.
inline constexpr int kCellCorners = 8;
inline constexpr int kCellEdges = 12;

/// One bit per corner, set for those that are inside (values above 0).
using CellPattern = std::uint8_t;
using CellValues = std::array<double, kCellCorners>;

struct CellSurface {
  /// Outward. A corner below kCellEdges is the vertex on that edge, kCellEdges + n is inner vertex n.
  std::vector<std::array<std::uint8_t, 3>> triangles;
  /// Vertices strictly inside the cell: the weights, which sum up to 1, of the vertices on edges.
  std::vector<std::array<double, kCellEdges>> inner;
};

/// The surfaces of all cells. Two cells with a common face have the same edges in it, and no edge that joins two
/// vertices of a face lies anywhere else, so that what cells make together is closed and manifold.
///
/// What the interpolant does on a face with opposite corners inside is decided by the asymptotic decider (G. M.
/// Nielson, B. Hamann, *The asymptotic decider*, Visualization 1991); what it does within the cell by following it over
/// all slices of the cell, which answers what the tests by E. V. Chernyaev (*Marching Cubes 33*, CERN CN/95-17, 1995)
/// and T. Lewiner et al. (*Efficient implementation of Marching Cubes' cases with topological guarantees*, Journal of
/// Graphics Tools 8, 2003) ask, without tables of cases. Where parts of the inside or the outside are connected through
/// the cell only, there is a tube between parts of the surface. Inner vertices keep edges of triangles out of faces.
///
/// Ties, as masks have them, are decided towards outside, and a cell with a tie on a face has no tube. So the parts of
/// a mask's inside are those of voxels with common faces, and those of its outside of voxels with common corners.
class CellSurfaces {
 public:
  /// Column a of `steps`: the cell's extent along axis a (mm). It decides between triangles for the same surface.
  explicit CellSurfaces(const Eigen::Matrix3d& steps);
  CellSurfaces(const CellSurfaces&) = delete;
  CellSurfaces& operator=(const CellSurfaces&) = delete;

  /// The surface of a cell whose pattern leaves one possibility, nullptr otherwise.
  const CellSurface* without_values(CellPattern pattern) const { return only_[pattern]; }

  /// The surface for any cell. No value may be 0, and those above 0 must be the pattern's corners. The result lives
  /// until the next call with the same `room`, which holds surfaces that are not kept.
  const CellSurface& with_values(CellPattern pattern, const CellValues& values, CellSurface& room) const;

 private:
  /// Of one pattern. A choice has bit n set if the inside is connected on the n-th ambiguous face.
  struct Possibilities {
    std::vector<int> ambiguous_faces;
    std::vector<std::vector<std::vector<int>>> loops;  ///< by the choice: edges around every part of the surface
    std::vector<CellSurface> disks;                    ///< by the choice: the surface without tubes
  };

  Eigen::Matrix3d steps_;
  std::array<Possibilities, 256> possible_;
  std::array<const CellSurface*, 256> only_{};
};

}  // namespace vmesh
