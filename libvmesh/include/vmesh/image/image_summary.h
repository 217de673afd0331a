#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "vmesh/core/progress.h"
#include "vmesh/image/image_io.h"
#include "vmesh/image/image_slices.h"

namespace vmesh {

/// The voxels of one value.
struct ImageLabel {
  float value = 0;
  std::uint64_t voxels = 0;
  std::uint64_t components = 0;  ///< voxels that touch are connected, if only at a corner (26 neighbours)
  double volume_mm3 = 0;
};

/// The least value that at least `percent` of the voxels do not exceed.
struct Percentile {
  double percent = 0;
  float value = 0;
};

/// How the values of all voxels are distributed.
struct GreyValues {
  float least = 0, greatest = 0;
  double mean = 0;
  /// Exact for whole numbers up to 65536, else nearer to 0 by less than 1/32768 of the value.
  std::array<Percentile, 5> percentiles = {{{1, 0}, {50, 0}, {90, 0}, {99, 0}, {99.9, 0}}};
};

/// What an image holds. Labels if it has at most kMostLabels values besides 0, all of them whole numbers; else grey
/// values.
struct ImageSummary {
  static constexpr std::size_t kMostLabels = 64;

  ImageFrame image;
  std::uint64_t zeros = 0;         ///< voxels of value 0
  std::vector<ImageLabel> labels;  ///< all values but 0, ascending; empty for grey values
  std::optional<GreyValues> grey;  ///< instead of labels

  std::uint64_t voxels() const {
    return std::uint64_t{1} * image.frame.size[0] * image.frame.size[1] * image.frame.size[2];
  }
};

/// Reads an image slice by slice, in the memory of a few slices and some megabytes (130 at most, for grey values spread
/// over all powers of ten). Throws like read_image(), and Cancelled.
ImageSummary summarize_image(const std::filesystem::path& path, const Progress& progress = {},
                             const ImageReadOptions& options = {});

/// The same of an image in memory.
ImageSummary summarize_image(const LoadedImage& image);

}  // namespace vmesh
