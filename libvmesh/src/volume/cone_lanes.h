#pragma once

#include <array>
#include <cstddef>

namespace vmesh {

/// Round cones side by side in single precision, as VesselField::Cone; lengths are in units of the surroundings that
/// they belong to.
struct ConeLanes {
  static constexpr std::size_t kCount = 8;
  using Numbers = std::array<float, kCount>;

  Numbers origin_x, origin_y, origin_z, axis_x, axis_y, axis_z;
  Numbers r0, taper;                 ///< r1 - r0
  Numbers rounding, rounding_taper;  ///< shares of the blend
  Numbers inv_length2, lag, t_low, t_high;
  Numbers reach;  ///< beyond the nearest cone, up to which it may be blended in
  /// Farther from there than this radius plus the distance of the nearest cone none of them is near or blended in.
  float center_x, center_y, center_z, radius;
};

inline constexpr std::size_t kMostConeLanes = 16;  ///< that a query looks at

/// A point, and where to look first.
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

/// VesselField's blended distance from `count` lanes. All do the same operations in the same order, so the results are
/// the same to the bit.
using LaneSampler = LaneSample (*)(const ConeLanes* lanes, std::size_t count, const LaneQuery& query);
LaneSampler plain_lane_sampler();
/// Null where the machine, or the compiler, cannot.
LaneSampler avx2_lane_sampler();
LaneSampler best_lane_sampler();

}  // namespace vmesh
