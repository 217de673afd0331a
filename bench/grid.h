#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vmesh/image/voxel_image.h"

namespace vmesh::bench {

using Box = Eigen::AlignedBox3d;

/// Cubic voxels over a box, all of one value.
inline VoxelImage grid_over(const Box& box, double step, float value) {
  VoxelImage image;
  for (int a = 0; a < 3; ++a) image.size[a] = static_cast<std::size_t>(std::ceil(box.sizes()[a] / step)) + 1;
  image.origin = box.min();
  image.steps *= step;
  image.values.assign(image.size[0] * image.size[1] * image.size[2], value);
  return image;
}

/// Calls visit(position, number) for the voxels of a grid whose centres are in a box.
template <class Visit>
void for_voxels_in(const VoxelImage& grid, const Box& box, Visit&& visit) {
  std::array<std::size_t, 3> low, high;
  for (int a = 0; a < 3; ++a) {
    const double step = grid.steps(a, a), last = static_cast<double>(grid.size[a] - 1);
    const double first = std::ceil((box.min()[a] - grid.origin[a]) / step);
    const double end = std::floor((box.max()[a] - grid.origin[a]) / step);
    if (end < 0 || first > last) return;
    low[a] = static_cast<std::size_t>(std::max(first, 0.0));
    high[a] = static_cast<std::size_t>(std::min(end, last));
  }
  for (std::size_t k = low[2]; k <= high[2]; ++k) {
    for (std::size_t j = low[1]; j <= high[1]; ++j) {
      for (std::size_t i = low[0]; i <= high[0]; ++i) {
        const Vec3 index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        visit(grid.position(index), grid.offset(i, j, k));
      }
    }
  }
}

}  // namespace vmesh::bench
