#pragma once

#include <span>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Triangles between the corners of a polygon that is flat, or nearly so, oriented as it is: the constrained Delaunay
/// triangulation of its projection along its normal (CGAL). If the projection is not simple (coincident corners,
/// crossing edges), a fan around the first corner. Empty for less than three corners.
std::vector<Triangle> triangulate_polygon(std::span<const Vec3> corners);

}  // namespace vmesh
