#include "image/level_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

namespace vmesh {
namespace {

constexpr float kLeastShare = 1e-3f;  // of an edge between samples: least distance of a vertex from its ends
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The least float that is at least `level`.
float rounded_up(double level) {
  const auto rounded = static_cast<float>(level);
  return static_cast<double>(rounded) < level ? std::nextafter(rounded, kInfinity) : rounded;
}

}  // namespace

LevelSamples::LevelSamples(const VoxelImage& image, double level)
    : image_(image),
      level_(level),
      size_{image.size[0] + 2, image.size[1] + 2, image.size[2] + 2},
      origin_(image.position(Vec3::Constant(-1))),
      words_((size_[0] + 63) / 64),
      inside_(words_ * size_[1] * size_[2], 0) {
  std::vector<float> lowest(image.size[2], kInfinity), highest(image.size[2], -kInfinity);
  const float least_inside = rounded_up(level);
  tbb::parallel_for(std::size_t{0}, image.size[2],
                    [&](std::size_t k) { fill_rows(k, least_inside, lowest[k], highest[k]); });
  const auto as_float = static_cast<float>(level);
  const float low = *std::min_element(lowest.begin(), lowest.end()) - as_float;
  const float high = *std::max_element(highest.begin(), highest.end()) - as_float;
  border_ = low < 0 ? low : -std::max(high, 1.0f);
  steepest_ = std::max(high, border_) - std::min(low, border_);
}

/// The bits of slice k of the image, and its lowest and highest value.
void LevelSamples::fill_rows(std::size_t k, float least_inside, float& lowest, float& highest) {
  const std::size_t length = image_.size[0];
  for (std::size_t j = 0; j < image_.size[1]; ++j) {
    const float* values = image_.values.data() + image_.offset(0, j, k);
    std::uint64_t* bits = inside_.data() + ((k + 1) * size_[1] + j + 1) * words_;
    for (std::size_t i = 0; i < length; ++i) {
      lowest = values[i] < lowest ? values[i] : lowest;
      highest = values[i] > highest ? values[i] : highest;
    }
    for (std::size_t word = 0, i = 0; word < words_; ++word) {
      std::uint64_t filled = 0;
      for (std::size_t bit = word == 0 ? 1 : 0; bit < 64 && i < length; ++bit, ++i)
        filled |= static_cast<std::uint64_t>(values[i] >= least_inside) << bit;
      bits[word] = filled;
    }
  }
}

float LevelSamples::unmoved(std::size_t i, std::size_t j, std::size_t k) const {
  return is_border(i, j, k) ? border_
                            : static_cast<float>(static_cast<double>(image_.at(i - 1, j - 1, k - 1)) - level_);
}

/// The largest difference between a sample and its neighbours.
float LevelSamples::steepness(std::size_t i, std::size_t j, std::size_t k) const {
  const float value = unmoved(i, j, k);
  float most = 0;
  const auto compare = [&](float other) { most = std::max(most, std::abs(other - value)); };
  if (i > 0) compare(unmoved(i - 1, j, k));
  if (j > 0) compare(unmoved(i, j - 1, k));
  if (k > 0) compare(unmoved(i, j, k - 1));
  if (i + 1 < size_[0]) compare(unmoved(i + 1, j, k));
  if (j + 1 < size_[1]) compare(unmoved(i, j + 1, k));
  if (k + 1 < size_[2]) compare(unmoved(i, j, k + 1));
  return most;
}

float LevelSamples::value(std::size_t i, std::size_t j, std::size_t k) const {
  const float value = unmoved(i, j, k);
  if (std::abs(value) >= kLeastShare * steepest_ && value != 0) return value;
  const float least = std::max(kLeastShare * steepness(i, j, k), 1e-30f);
  if (std::abs(value) >= least) return value;
  return (inside_row(j, k)[i / 64] >> i % 64 & 1) != 0 ? least : -least;
}

}  // namespace vmesh
