#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A triangulation that fills a flat ring. Faces index the ring's vertices, then, from ring.size() on, the added ones.
struct Disc {
  std::vector<Vec3> vertices;  ///< added inside the ring
  std::vector<Triangle> faces;
};

/// Area of a flat polygon as a vector along its normal, and the centroid of that area.
Vec3 area_vector(const std::vector<Vec3>& ring);
Vec3 area_centroid(const std::vector<Vec3>& ring);

/// Triangles about as large as the ring's edges, counter-clockwise about `normal` like the ring: concentric rings with
/// ever fewer vertices. A ring that is not wholly visible from its centroid is triangulated without added vertices.
Disc fill_ring(const std::vector<Vec3>& ring, const Vec3& normal);

}  // namespace vmesh
