// Slice data in DICOM files, internal to the module.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::image {

/// A DICOM file and the series that it belongs to.
struct DicomFile {
  std::filesystem::path path;
  std::string series;  ///< its UID; for a multi-frame file, which is a series by itself, its path
  std::string modality, description;
  std::size_t columns = 0, rows = 0;
  bool many_frames = false;
};

struct DicomSlice {
  std::filesystem::path path;
  std::size_t frame = 0;              ///< number within the file
  Vec3 position = Vec3::Zero();       ///< centre of its first voxel, LPS, mm
  Eigen::Matrix<double, 3, 2> steps;  ///< to the next voxel of a row, and to the next row
  std::size_t columns = 0, rows = 0;
  double slope = 1, intercept = 0;  ///< value = slope * stored + intercept
  int segment = 0;                  ///< segment of a segmentation's frame; 0: not a segmentation
};

/// How the voxels of a file are stored.
struct DicomVoxels {
  std::size_t bits = 16;  ///< per voxel; 1 in segmentations
  double slice_step = 0;  ///< distance between slices (mm); 0: unknown
};

/// nullopt if it contains no image (a report, a contour, raw data). Throws InvalidInput if the file is damaged.
std::optional<DicomFile> identify(const std::filesystem::path& path);

/// The slices of a file, one for each frame. Throws InvalidInput if their positions are unknown, Unsupported for
/// colours and for anything but stacks of slices. Also fills `voxels` unless null.
std::vector<DicomSlice> slices_of(const DicomFile& file, DicomVoxels* voxels = nullptr);

/// Throws InvalidInput unless the file extends to the end of its voxels (`bytes` if uncompressed). GDCM reads truncated
/// files without an error.
void check_not_cut_off(const std::filesystem::path& path, std::size_t bytes);

}  // namespace vmesh::image
