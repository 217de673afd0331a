#include "value_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vmesh::image {
namespace {

constexpr std::uint32_t kSign = std::uint32_t{1} << 31;

/// Integers that ascend as the numbers do.
std::uint32_t ordered_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);  // -0 becomes 0
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

/// The number nearest to 0 of those whose ordered bits are `key` without the last eight.
float value_of(std::uint32_t key) {
  const std::uint32_t ordered = key << 8;
  return std::bit_cast<float>((ordered & kSign) != 0 ? ordered & ~kSign : ~(ordered | 0xffu));
}

}  // namespace

void ValueHistogram::add(float value, std::uint64_t count) {
  const std::uint32_t key = ordered_bits(value) >> 8;
  std::unique_ptr<Page>& page = pages_[key >> 8];
  if (!page) page = std::make_unique<Page>();
  (*page)[key & 0xffu] += count;
  total_ += count;
}

float ValueHistogram::quantile(double fraction) const {
  const double rank = std::max(1.0, std::ceil(fraction * static_cast<double>(total_)));
  std::uint64_t below = 0;
  float value = 0;
  for (std::size_t p = 0; p < pages_.size(); ++p) {
    if (!pages_[p]) continue;
    for (std::size_t slot = 0; slot < pages_[p]->size(); ++slot) {
      const std::uint64_t count = (*pages_[p])[slot];
      if (count == 0) continue;
      value = value_of(static_cast<std::uint32_t>(p << 8 | slot));
      below += count;
      if (static_cast<double>(below) >= rank) return value;
    }
  }
  return value;
}

}  // namespace vmesh::image
