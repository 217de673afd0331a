#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A surface of truncated cones and the segments it comes from.
struct TruncatedCones {
  TriMesh mesh;
  std::vector<Index> segment;  ///< of the centerline, one per vertex
  std::vector<double> radius;  ///< of the vessel there, one per vertex (mm)
};

/// One truncated cone per segment, not joined, as in Table 2 of the paper: a ring of `sides` vertices around each of
/// its two nodes, in the plane across the segment and as wide as the node's radius, and a point in the centre of the
/// ring at its node b. That is 2 * sides + 1 vertices and 4 * sides - 2 faces; every cone is closed and faces outwards.
/// Cone s has the vertices from s * (2 * sides + 1) on. Isolated nodes have none. Throws InvalidInput unless 3 <= sides
/// <= 1000, and for a centerline without a segment.
TruncatedCones truncated_cones(const Centerline& centerline, int sides = 18);

}  // namespace vmesh
