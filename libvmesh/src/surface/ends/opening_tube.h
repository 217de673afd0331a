#pragma once

#include <vector>

#include "vmesh/surface/generate.h"

namespace vmesh {

/// A further vertex with the binding and radius of another; returns its number.
Index add_vertex_like(GenerateResult& result, Index like, const Vec3& position);

/// Mean length of the edges of a closed ring.
double mean_edge(const std::vector<Vec3>& ring);

/// Lays a tube from the opening's ring to `target`, where every vertex of the ring would end, in bands of triangles
/// about as large as those of the ring; the far end becomes the opening's ring. Every other ring is turned by half a
/// step, the last one too if the number of bands is odd: then it has vertices between the points of `target`.
void extend_opening(GenerateResult& result, Opening& opening, const std::vector<Vec3>& target);

}  // namespace vmesh
