// What DICOM files say of their slices, internal to the module.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh::image {

/// Tells series apart.
struct DicomFile {
  std::filesystem::path path;
  std::string series;  ///< its UID; of a file with many frames, which is a series by itself, its path
  std::string modality, description;
  std::size_t columns = 0, rows = 0;
  bool many_frames = false;
};

struct DicomSlice {
  std::filesystem::path path;
  std::size_t frame = 0;              ///< of the file's
  Vec3 position = Vec3::Zero();       ///< centre of its first voxel, LPS, mm
  Eigen::Matrix<double, 3, 2> steps;  ///< to the next voxel of a row, and to the next row
  std::size_t columns = 0, rows = 0;
  double slope = 1, intercept = 0;  ///< of its values, from those that are stored
  int segment = 0;                  ///< that the frame of a segmentation belongs to; 0: no segmentation
};

/// How the voxels of a file are stored.
struct DicomVoxels {
  std::size_t bits = 16;  ///< of each; 1 in segmentations
  double slice_step = 0;  ///< distance between slices (mm); 0: it does not say
};

/// Nothing when it holds no image: a report, a contour, raw data. Throws InvalidInput when the file is damaged.
std::optional<DicomFile> identify(const std::filesystem::path& path);

/// The slices of a file that holds some, one for each frame. Throws InvalidInput when it does not say where they lie,
/// Unsupported for colours and what is no stack of slices. `voxels`, unless null, is told as well.
std::vector<DicomSlice> slices_of(const DicomFile& file, DicomVoxels* voxels = nullptr);

/// Throws InvalidInput unless the file goes on to the end of its voxels, which are so many bytes when they are not
/// packed. GDCM reads what is cut off without an error.
void check_not_cut_off(const std::filesystem::path& path, std::size_t bytes);

}  // namespace vmesh::image
