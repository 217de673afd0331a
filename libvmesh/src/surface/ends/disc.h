#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// What fills a flat ring. Faces name the ring's vertices by their places in it, further ones from ring.size() on.
struct Disc {
  std::vector<Vec3> vertices;  ///< further ones
  std::vector<Triangle> faces;
};

/// Area of a flat polygon as a vector along its normal, and the centroid of that area.
Vec3 area_vector(const std::vector<Vec3>& ring);
Vec3 area_centroid(const std::vector<Vec3>& ring);

/// Triangles about as large as the ring's edges, counter-clockwise about `normal` as the ring is: rings within rings,
/// of fewer and fewer vertices. A ring that is not seen as a whole from its centroid is triangulated without further
/// vertices.
Disc fill_ring(const std::vector<Vec3>& ring, const Vec3& normal);

}  // namespace vmesh
