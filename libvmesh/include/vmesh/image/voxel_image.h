#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// A scalar image on a regular grid, placed in the internal frame (LPS, mm). Values are those at the centres of voxels.
struct VoxelImage {
  std::array<std::size_t, 3> size = {0, 0, 0};
  std::vector<float> values;  ///< size[0] * size[1] * size[2] of them, the first axis fastest

  Vec3 origin = Vec3::Zero();                           ///< centre of voxel (0, 0, 0)
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();  ///< column a: from one voxel to the next along axis a (mm)

  std::size_t offset(std::size_t i, std::size_t j, std::size_t k) const { return (k * size[1] + j) * size[0] + i; }
  float at(std::size_t i, std::size_t j, std::size_t k) const { return values[offset(i, j, k)]; }

  /// Position of voxel coordinates, which need not be integers.
  Vec3 position(const Vec3& voxel) const { return origin + steps * voxel; }
  /// Distance between neighbouring voxels along every axis (mm).
  Vec3 spacing() const { return steps.colwise().norm(); }
};

}  // namespace vmesh
