#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross() compiles without it and then does not link

namespace vmesh {

/// A point or direction in the internal frame: LPS, millimetres.
using Vec3 = Eigen::Vector3d;

/// Index of a node, segment, vertex or face.
using Index = std::uint32_t;

/// "No element": the value of an Index that points at nothing.
inline constexpr Index kNone = std::numeric_limits<Index>::max();

}  // namespace vmesh
