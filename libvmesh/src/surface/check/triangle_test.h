#pragma once

#include <array>
#include <vector>

#include "vmesh/volume/vessel_field.h"

namespace vmesh {

using TrianglePoints = std::array<Vec3, 3>;

Vec3 triangle_center(const TrianglePoints& q);
/// Largest distance of a corner from `center`.
double triangle_reach(const TrianglePoints& q, const Vec3& center);

/// Whether whole triangles are proven to be outside, or inside, of the volume of these cones of a field: by bounds on
/// its value over them (ErrorProof), and where these do not tell over their parts.
bool are_outside(const VesselField& field, const std::vector<TrianglePoints>& triangles,
                 const std::vector<Index>& cones);
bool are_inside(const VesselField& field, const std::vector<TrianglePoints>& triangles,
                const std::vector<Index>& cones);

}  // namespace vmesh
