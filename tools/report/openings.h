#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::tool {

/// A hole that the boundary of a surface runs around; loops that touch count as one.
struct BoundaryLoop {
  std::size_t edges = 0;
  Vec3 center = Vec3::Zero();  ///< of the edges
  double area_mm2 = 0;         ///< of the flat lid that leaves out as much as it adds (the loop's vector area)
};

/// Largest first.
std::vector<BoundaryLoop> boundary_loops(const TriMesh& mesh);

}  // namespace vmesh::tool
