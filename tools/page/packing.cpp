#include "page/packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vmesh::tool {
namespace {

constexpr double kPointSteps = 65'535, kValueSteps = 4'095;

std::uint64_t with_sign_last(std::int64_t number) {
  return (static_cast<std::uint64_t>(number) << 1) ^ static_cast<std::uint64_t>(number >> 63);
}

void append(std::uint64_t number, std::vector<unsigned char>& bytes) {
  for (; number >= 0x80; number >>= 7) bytes.push_back(static_cast<unsigned char>(number | 0x80));
  bytes.push_back(static_cast<unsigned char>(number));
}

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string pack(std::span<const std::int64_t> numbers, std::size_t stride) {
  std::vector<unsigned char> bytes;
  bytes.reserve(2 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    append(with_sign_last(numbers[i] - (i < stride ? 0 : numbers[i - stride])), bytes);
  return base64(bytes);
}

PointGrid grid_over(std::span<const Vec3> points) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Vec3& p : points) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (!low.allFinite()) return {};
  const double side = (high - low).maxCoeff();
  return {low, side > 0 ? side / kPointSteps : 1};
}

std::vector<std::int64_t> on_grid(std::span<const Vec3> points, const PointGrid& grid) {
  std::vector<std::int64_t> places;
  places.reserve(3 * points.size());
  for (const Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis)
      places.push_back(p.allFinite() ? std::llround((p[axis] - grid.low[axis]) / grid.step) : 0);
  }
  return places;
}

ValueGrid grid_over(std::span<const double> values, bool labels) {
  if (labels) return {};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low < high)) return {std::isfinite(low) ? low : 0, 1};
  return {low, (high - low) / kValueSteps};
}

std::vector<std::int64_t> on_grid(std::span<const double> values, const ValueGrid& grid) {
  std::vector<std::int64_t> places;
  places.reserve(values.size());
  for (const double value : values)
    places.push_back(std::isfinite(value) ? std::llround((value - grid.low) / grid.step) : kNoValue);
  return places;
}

}  // namespace vmesh::tool
