#pragma once

#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// Adds a geodesic sphere to `surface`: an icosahedron whose faces are split edge-centrically once (42 vertices,
/// 80 faces), turned by `orientation`. Vertices are bound through the field, started from `hint`. Returns the new
/// vertices.
std::vector<Vertex> add_geodesic_sphere(BoundSurface& surface, const Vec3& center, double radius,
                                        const Eigen::Matrix3d& orientation, Index hint);

}  // namespace vmesh
