#pragma once

#include <array>
#include <cstddef>

#include "vmesh/core/instruction_set.h"

namespace vmesh {

/// Round cones in SIMD lanes, single precision, with the members of VesselField::Cone; lengths are in units of their
/// Surroundings.
struct ConeLanes {
  static constexpr std::size_t kCount = 8;
  using Numbers = std::array<float, kCount>;

  Numbers origin_x, origin_y, origin_z, axis_x, axis_y, axis_z;
  Numbers r0, taper;                 ///< r1 - r0
  Numbers rounding, rounding_taper;  ///< shares of the blend
  Numbers inv_length2, lag, t_low, t_high;
  Numbers reach;  ///< how much farther than the nearest cone it may be and still be blended
  /// Bounding sphere of the lanes: farther from it than the distance of the nearest cone, none of them matters.
  float center_x, center_y, center_z, radius;
};

inline constexpr std::size_t kMostConeLanes = 16;  ///< per query

/// A query point, and the cone to try first.
struct LaneQuery {
  float x, y, z;
  float blend;
  std::size_t first;  ///< number of the cone that is likely to be near
};

struct LaneSample {
  float distance = 0;
  float gradient_x = 0, gradient_y = 0, gradient_z = 0;
  float t = 0;
  float least = 0;          ///< distance of the nearest cone, without blending
  std::size_t nearest = 0;  ///< its number
};

/// VesselField's blended distance from `count` lanes.
using LaneSampler = LaneSample(const ConeLanes* lanes, std::size_t count, const LaneQuery& query);
namespace plain {
LaneSampler sample_lanes;
}
namespace avx2 {
LaneSampler sample_lanes;
}
LaneSampler& lane_sampler(InstructionSet set);

}  // namespace vmesh
