#pragma once

#include <span>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Triangles between the corners of a polygon that is flat, or nearly so, oriented as it is: the constrained Delaunay
/// triangulation of its projection along its normal (CGAL). One that is not simple there, such as one with two corners
/// at one place or edges that cross, becomes a fan around its first corner. Less than three corners: nothing.
std::vector<Triangle> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace vmesh
