#pragma once

#include "vmesh/image/voxel_image.h"

namespace vmesh {

/// 1 where the value is at least `low` and at most `high`, 0 elsewhere.
VoxelImage binary_mask(const VoxelImage& image, double low, double high);

/// Voxels low[a] to high[a] along every axis a, both included. Precondition: low <= high < size.
VoxelImage cropped(const VoxelImage& image, const std::array<std::size_t, 3>& low,
                   const std::array<std::size_t, 3>& high);

/// The smallest crop that holds all values of at least `isovalue` and `margin` mm around them, where the image goes
/// that far. Throws InvalidInput when there is no such value.
VoxelImage cropped_to(const VoxelImage& image, double isovalue, double margin);

/// The size that resampled() gives the image. Throws InvalidInput as it does.
std::array<std::size_t, 3> resampled_size(const VoxelImage& image, double spacing);

/// The same image on cubic voxels of `spacing` mm along the same axes, values interpolated linearly. The grid is
/// centred in the old one. Throws InvalidInput unless 0 < spacing, and when that asks for more than 2^31 voxels.
VoxelImage resampled(const VoxelImage& image, double spacing);

/// Convolved with a Gaussian of standard deviation `sigma` mm, cut off at 3 sigma; beyond its border the image is taken
/// to go on with the values there. Throws InvalidInput unless 0 < sigma.
VoxelImage smoothed(const VoxelImage& image, double sigma);

}  // namespace vmesh
