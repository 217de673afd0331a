#pragma once

#include <vector>

#include "quality/triangle_tree.h"

namespace vmesh {

/// Tells whether every point of a triangle has a closed mesh within a distance s: when the triangle moved by s along
/// its normal and moved back by s both miss the mesh, and the mesh is crossed an odd number of times between the two,
/// they lie on different sides of it, and so does each pair of moved points.
class Sandwich {
 public:
  /// Keeps references. The mesh need be no manifold: closed are meshes with an even number of faces at every edge.
  Sandwich(const TriMesh& mesh, const TriangleTree& tree);

  /// Whether the mesh is closed, points at the same place taken as one. Without that nothing holds.
  bool available() const { return closed_; }

  /// False means "cannot tell": touching and rounding count against it.
  bool within(const std::array<Vec3, 3>& triangle, double s);

 private:
  const TriMesh& mesh_;
  const TriangleTree& tree_;
  double rounding_;  // mm
  bool closed_;
  std::vector<Index> near_;
};

/// Whether every edge has an even number of faces, points at the same place taken as one.
bool bounds_a_volume(const TriMesh& mesh);

}  // namespace vmesh
