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

/// Sorts slices by position along their normal. `name` names the series in messages. Throws InvalidInput if they are
/// not parallel, differ in size, coincide, are not evenly spaced, or some are missing.
///
/// Frames of a segmentation may coincide (one per segment), and may be missing where they are empty; `slice_step` is
/// then the distance between layers, or 0 for the smallest one found.
DicomStack stacked(std::vector<DicomSlice> slices, double slice_step, const std::string& name);

}  // namespace vmesh::image
