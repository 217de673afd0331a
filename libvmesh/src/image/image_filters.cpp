#include "vmesh/image/image_filters.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vmesh/core/error.h"

namespace vmesh {
namespace {

constexpr std::size_t kMostVoxels = std::size_t{1} << 31;

VoxelImage like(const VoxelImage& image) {
  VoxelImage result;
  result.size = image.size;
  result.origin = image.origin;
  result.steps = image.steps;
  return result;
}

template <class Visit>
void for_each_voxel(const VoxelImage& image, Visit visit) {
  for (std::size_t k = 0; k < image.size[2]; ++k)
    for (std::size_t j = 0; j < image.size[1]; ++j)
      for (std::size_t i = 0; i < image.size[0]; ++i) visit(std::array<std::size_t, 3>{i, j, k});
}

/// Position of a new sample between two old ones along an axis.
struct Between {
  std::size_t low, high;
  float weight;  // of high
};

std::vector<Between> places_along(std::size_t old_count, std::size_t new_count, double first, double step) {
  std::vector<Between> places(new_count);
  for (std::size_t n = 0; n < new_count; ++n) {
    const double x = std::clamp(first + step * static_cast<double>(n), 0.0, static_cast<double>(old_count - 1));
    const auto low = static_cast<std::size_t>(x);
    places[n] = {low, std::min(low + 1, old_count - 1), static_cast<float>(x - static_cast<double>(low))};
  }
  return places;
}

/// The image resampled along `axis`: new voxel n is at the old coordinate first + step * n.
VoxelImage resampled_along(const VoxelImage& image, int axis, std::size_t count, double first, double step) {
  VoxelImage result = like(image);
  result.size[axis] = count;
  result.origin += first * image.steps.col(axis);
  result.steps.col(axis) *= step;
  result.values.resize(result.size[0] * result.size[1] * result.size[2]);
  const std::vector<Between> places = places_along(image.size[axis], count, first, step);
  std::size_t out = 0;
  for_each_voxel(result, [&](std::array<std::size_t, 3> voxel) {
    const auto [low, high, weight] = places[voxel[axis]];
    voxel[axis] = low;
    const float a = image.at(voxel[0], voxel[1], voxel[2]);
    voxel[axis] = high;
    const float b = image.at(voxel[0], voxel[1], voxel[2]);
    result.values[out++] = a + weight * (b - a);
  });
  return result;
}

/// Half of a Gaussian's weights, from its centre outwards; all together add up to 1.
std::vector<float> gaussian_weights(double sigma_voxels) {
  const auto reach = static_cast<std::size_t>(std::ceil(3 * sigma_voxels));
  std::vector<double> weights(reach + 1);
  double sum = 0;
  for (std::size_t n = 0; n <= reach; ++n) {
    const double x = static_cast<double>(n) / sigma_voxels;
    weights[n] = std::exp(-0.5 * x * x);
    sum += (n == 0 ? 1 : 2) * weights[n];
  }
  std::vector<float> normalized;
  for (const double w : weights) normalized.push_back(static_cast<float>(w / sum));
  return normalized;
}

/// Convolves the line of `count` values that starts at `first` with step `stride`.
void convolve_line(float* first, std::size_t count, std::size_t stride, const std::vector<float>& weights,
                   std::vector<float>& line) {
  const std::size_t reach = weights.size() - 1;
  line.resize(count + 2 * reach);
  for (std::size_t n = 0; n < line.size(); ++n)
    line[n] =
        first[stride * std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(n) - static_cast<std::ptrdiff_t>(reach),
                                                  0, static_cast<std::ptrdiff_t>(count) - 1)];
  for (std::size_t n = 0; n < count; ++n) {
    const float* center = line.data() + n + reach;
    float sum = weights[0] * center[0];
    for (std::size_t w = 1; w <= reach; ++w) sum += weights[w] * (center[w] + *(center - w));
    first[stride * n] = sum;
  }
}

void convolve_along(VoxelImage& image, int axis, const std::vector<float>& weights) {
  const std::size_t stride = axis == 0 ? 1 : axis == 1 ? image.size[0] : image.size[0] * image.size[1];
  std::vector<float> line;
  const auto [ni, nj, nk] = image.size;
  const std::array<std::size_t, 3> starts = {axis == 0 ? 1 : ni, axis == 1 ? 1 : nj, axis == 2 ? 1 : nk};
  for (std::size_t k = 0; k < starts[2]; ++k)
    for (std::size_t j = 0; j < starts[1]; ++j)
      for (std::size_t i = 0; i < starts[0]; ++i)
        convolve_line(image.values.data() + image.offset(i, j, k), image.size[axis], stride, weights, line);
}

}  // namespace

VoxelImage binary_mask(const VoxelImage& image, double low, double high) {
  VoxelImage mask = like(image);
  mask.values.reserve(image.values.size());
  for (const float value : image.values) mask.values.push_back(value >= low && value <= high ? 1.0f : 0.0f);
  return mask;
}

VoxelImage binary_mask(const VoxelImage& image, std::span<const double> labels) {
  VoxelImage mask = like(image);
  mask.values.reserve(image.values.size());
  for (const float value : image.values)
    mask.values.push_back(std::find(labels.begin(), labels.end(), double{value}) != labels.end() ? 1.0f : 0.0f);
  return mask;
}

VoxelImage cropped(const VoxelImage& image, const std::array<std::size_t, 3>& low,
                   const std::array<std::size_t, 3>& high) {
  VoxelImage result = like(image);
  for (int a = 0; a < 3; ++a) result.size[a] = high[a] - low[a] + 1;
  result.origin =
      image.position(Vec3(static_cast<double>(low[0]), static_cast<double>(low[1]), static_cast<double>(low[2])));
  result.values.reserve(result.size[0] * result.size[1] * result.size[2]);
  for_each_voxel(result, [&](const std::array<std::size_t, 3>& voxel) {
    result.values.push_back(image.at(low[0] + voxel[0], low[1] + voxel[1], low[2] + voxel[2]));
  });
  return result;
}

VoxelImage cropped_to(const VoxelImage& image, double isovalue, double margin) {
  std::array<std::size_t, 3> low = image.size, high = {0, 0, 0};
  bool any = false;
  for_each_voxel(image, [&](const std::array<std::size_t, 3>& voxel) {
    if (image.at(voxel[0], voxel[1], voxel[2]) < isovalue) return;
    any = true;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], voxel[a]);
      high[a] = std::max(high[a], voxel[a]);
    }
  });
  if (!any) throw InvalidInput("there is nothing to contour: no voxel is inside");
  const Vec3 spacing = image.spacing();
  for (int a = 0; a < 3; ++a) {
    const auto more = static_cast<std::size_t>(std::ceil(std::min(margin / spacing[a], 1e9)));
    low[a] -= std::min(low[a], more);
    high[a] = std::min(high[a] + more, image.size[a] - 1);
  }
  return cropped(image, low, high);
}

std::array<std::size_t, 3> resampled_size(const VoxelImage& image, double spacing) {
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw InvalidInput("the spacing of a resampled image must be positive");
  const Vec3 old_spacing = image.spacing();
  std::array<std::size_t, 3> counts{};
  double voxels = 1;
  for (int a = 0; a < 3; ++a) {
    const double count = std::max(1.0, std::round(static_cast<double>(image.size[a]) * old_spacing[a] / spacing));
    voxels *= count;
    counts[a] = static_cast<std::size_t>(std::min(count, 1e18));
  }
  if (voxels > static_cast<double>(kMostVoxels))
    throw InvalidInput("a spacing of " + std::to_string(spacing) +
                       " mm needs more than 2^31 voxels; choose a larger one");
  return counts;
}

VoxelImage resampled(const VoxelImage& image, double spacing) {
  const std::array<std::size_t, 3> counts = resampled_size(image, spacing);
  const Vec3 old_spacing = image.spacing();
  VoxelImage result = image;
  for (int a = 0; a < 3; ++a) {
    const double step = spacing / old_spacing[a];
    const double first = 0.5 * (static_cast<double>(image.size[a] - 1) - step * static_cast<double>(counts[a] - 1));
    result = resampled_along(result, a, counts[a], first, step);
  }
  return result;
}

VoxelImage smoothed(const VoxelImage& image, double sigma) {
  if (!(sigma > 0) || !std::isfinite(sigma)) throw InvalidInput("the width of a Gaussian must be positive");
  VoxelImage result = image;
  const Vec3 spacing = image.spacing();
  for (int a = 0; a < 3; ++a) {
    // A wider one would only take longer.
    const double sigma_voxels = std::min(sigma / spacing[a], static_cast<double>(10 * image.size[a]));
    convolve_along(result, a, gaussian_weights(sigma_voxels));
  }
  return result;
}

}  // namespace vmesh
