#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vmesh/image/voxel_image.h"

namespace vmesh {

/// An image minus a level, with a border of outside samples, without a copy of it: sample (i, j, k) is that of voxel (i
/// - 1, j - 1, k - 1). Besides the image there is one bit per sample.
class LevelSamples {
 public:
  /// The image must outlive the samples and have a voxel.
  LevelSamples(const VoxelImage& image, double level);

  const std::array<std::size_t, 3>& size() const { return size_; }
  /// Whether samples are inside (at least the level), sample i at bit i % 64 of word i / 64. Bits past the row are 0.
  const std::uint64_t* inside_row(std::size_t j, std::size_t k) const {
    return inside_.data() + (k * size_[1] + j) * words_;
  }
  std::size_t words_per_row() const { return words_; }

  /// The value minus the level, moved away from 0 without changing its side where it is less than a thousandth of the
  /// largest difference between it and its neighbours: above 0 inside, below outside, never 0.
  float value(std::size_t i, std::size_t j, std::size_t k) const;

  /// Position in space (LPS, mm) of sample coordinates, which need not be integers.
  Vec3 position(const Vec3& sample) const { return origin_ + image_.steps * sample; }
  const Eigen::Matrix3d& steps() const { return image_.steps; }

 private:
  bool is_border(std::size_t i, std::size_t j, std::size_t k) const {
    return i == 0 || j == 0 || k == 0 || i == size_[0] - 1 || j == size_[1] - 1 || k == size_[2] - 1;
  }
  float unmoved(std::size_t i, std::size_t j, std::size_t k) const;
  float steepness(std::size_t i, std::size_t j, std::size_t k) const;
  void fill_rows(std::size_t k, float least_inside, float& lowest, float& highest);

  const VoxelImage& image_;
  double level_;
  std::array<std::size_t, 3> size_;
  Vec3 origin_;
  std::size_t words_;
  std::vector<std::uint64_t> inside_;
  float border_ = 0;    // value of samples beyond the image
  float steepest_ = 0;  // no two samples differ by more
};

}  // namespace vmesh
