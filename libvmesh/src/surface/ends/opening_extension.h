#pragma once

#include <vector>

#include "vmesh/surface/generate.h"

namespace vmesh {

/// Adds a vertex with the binding and radius of another; returns its number.
Index add_vertex_like(GenerateResult& result, Index like, const Vec3& position);

/// Mean length of the edges of a closed ring.
double mean_edge(const std::vector<Vec3>& ring);

/// Extends the opening from its ring to `target` (the end point of every vertex of the ring) in bands of triangles
/// about as large as those at the ring; the last ring becomes the opening's. Every other ring is turned by half a step,
/// including the last one if the number of bands is odd: its vertices then lie between the points of `target`.
void extend_opening(GenerateResult& result, Opening& opening, const std::vector<Vec3>& target);

}  // namespace vmesh
