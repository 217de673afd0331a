// Numbers as the short text that a page carries them in; page/decode.js reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::tool {

/// RFC 4648, padded.
std::string base64(std::span<const unsigned char> bytes);

/// Every number less the one `stride` before it (the first ones as they are), the sign as the lowest bit, seven bits a
/// byte, the lowest first, all but the last with the highest bit set; then base64().
std::string pack(std::span<const std::int64_t> numbers, std::size_t stride = 1);

/// Points, or values, as whole numbers of steps.
struct PointGrid {
  Vec3 low = Vec3::Zero();
  double step = 1;
};
struct ValueGrid {
  double low = 0;
  double step = 1;
};

/// What stands for a value that is not finite.
inline constexpr std::int64_t kNoValue = -1;

/// 65,535 steps along the longest side of the box around the points. What is not finite does not count.
PointGrid grid_over(std::span<const Vec3> points);
/// Three numbers to a point: the nearest place of the grid. Points may lie outside of its box; what is not finite lies
/// at its lowest place.
std::vector<std::int64_t> on_grid(std::span<const Vec3> points, const PointGrid& grid);

/// 4,095 steps from the lowest to the highest value; steps of 1 from 0 for labels (whole numbers, -1 for none).
ValueGrid grid_over(std::span<const double> values, bool labels);
std::vector<std::int64_t> on_grid(std::span<const double> values, const ValueGrid& grid);

}  // namespace vmesh::tool
