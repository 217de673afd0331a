// Compact text encoding of the numbers in a page; page/decode.js reads it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::tool {

/// RFC 4648, padded.
std::string base64(std::span<const unsigned char> bytes);

/// Differences from the number `stride` before (the first ones as they are), with the sign in the lowest bit, as
/// variable-length integers (seven bits per byte, lowest first, the highest bit set in all but the last); then
/// base64().
std::string pack(std::span<const std::int64_t> numbers, std::size_t stride = 1);

/// A grid that represents points as integers.
struct PointGrid {
  Vec3 low = Vec3::Zero();
  double step = 1;
};
struct ValueGrid {
  double low = 0;
  double step = 1;
};

/// Represents a value that is not finite.
inline constexpr std::int64_t kNoValue = -1;

/// 65,535 steps along the longest side of the box around the points. Points that are not finite are ignored.
PointGrid grid_over(std::span<const Vec3> points);
/// Three numbers per point: the nearest grid point. Points may be outside the box; those that are not finite become its
/// lowest corner.
std::vector<std::int64_t> on_grid(std::span<const Vec3> points, const PointGrid& grid);

/// 4,095 steps from the lowest to the highest value; steps of 1 from 0 for labels (integers, -1 for none).
ValueGrid grid_over(std::span<const double> values, bool labels);
std::vector<std::int64_t> on_grid(std::span<const double> values, const ValueGrid& grid);

}  // namespace vmesh::tool
