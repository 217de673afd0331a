// What the ITK and GDCM readers return, internal to the module. They run in a child process: first for the header,
// then, once memory has been checked, for the voxels. Without Eigen, as ITK brings its own.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vmesh::image {

struct ForeignHeader {
  std::array<std::uint64_t, 3> size = {0, 0, 0};
  std::array<double, 3> origin = {0, 0, 0};      ///< LPS, mm
  std::array<std::array<double, 3>, 3> steps{};  ///< steps[a]: from one voxel to the next along axis a
  std::uint64_t bytes = 1;                       ///< of a voxel, as it is stored
  bool integer = false;                          ///< all values are integers
};

/// A reader's warnings, each a line with its end.
using Warnings = std::string;

/// MetaImage, NRRD, NIfTI and Analyze with voxels in another file.
ForeignHeader itk_header(const std::filesystem::path& path, Warnings& warnings);
Warnings itk_voxels(const std::filesystem::path& path, std::span<float> values);

/// DICOM: a file or a folder.
ForeignHeader dicom_header(const std::filesystem::path& path, Warnings& warnings);
Warnings dicom_voxels(const std::filesystem::path& path, std::span<float> values);

}  // namespace vmesh::image
