// Slices that make up a regular grid, internal to the module.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "dicom_tags.h"

namespace vmesh::image {

struct DicomStack {
  std::array<std::size_t, 3> size = {0, 0, 0};
  Vec3 origin = Vec3::Zero();
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();  ///< as in VoxelImage
  std::vector<DicomSlice> slices;
  std::vector<std::size_t> layer;  ///< of every slice, along the third axis
};

/// Sorts slices by where they lie along their normal. `name` is the series' in messages. Throws InvalidInput when they
/// are not parallel, differ in size, lie in one place, are not evenly spaced, or some are missing.
///
/// Frames of a segmentation may lie in one place, one for each segment, and be missing where nothing is in them;
/// `slice_step` is the distance between layers then, or 0: the smallest that there is.
DicomStack stacked(std::vector<DicomSlice> slices, double slice_step, const std::string& name);

}  // namespace vmesh::image
