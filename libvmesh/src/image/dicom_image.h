// What is read of a DICOM series, internal to the module. Both functions run in a child process: first for the header,
// then, once memory has been checked, for the voxels.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "vmesh/core/types.h"

namespace vmesh::image {

struct DicomHeader {
  std::array<std::size_t, 3> size = {0, 0, 0};
  Vec3 origin = Vec3::Zero();                           ///< LPS, mm
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();  ///< as in VoxelImage
  std::size_t bytes = 1;                                ///< of a voxel, as it is stored
  bool integer = false;                                 ///< all values are integers
};

/// Of a file or a folder.
DicomHeader dicom_header(const std::filesystem::path& path);

/// Reads the values; returns warnings, each a line with its end.
std::string dicom_voxels(const std::filesystem::path& path, std::span<float> values);

}  // namespace vmesh::image
