#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/image/voxel_image.h"

namespace vmesh {

/// Whether the name ends as an image's: .nii, .nii.gz, .nrrd or .mha, or, for ITK to read, .mhd, .nhdr, .hdr, .img or
/// .dcm; upper or lower case.
bool is_image_path(const std::filesystem::path& path);

/// The same, or a DICOM file of whatever name, or a folder with such files in it. Pipes are not waited for.
bool is_image(const std::filesystem::path& path);

struct LoadedImage {
  VoxelImage image;
  bool integer = false;               ///< the file stores whole numbers: labels, a mask or CT numbers
  std::vector<std::string> warnings;  ///< what the file does not say and was assumed
};

/// Reads a scalar image of three dimensions (more, when they have one sample), lying in space where 3D Slicer shows it:
/// NIfTI-1 and -2, NRRD, MetaImage, with header and voxels in one file, packed or not. In NIfTI, the sform wins over
/// the qform unless it is skewed. It takes at most 16 times as much memory as the voxels in the
/// file, unpacked (and 128 times as much as a file that is not packed), and a megabyte, whatever the header says.
///
/// In a build with ITK, also, in a child of this process and after asking for the memory: MetaImage, NRRD and NIfTI (or
/// Analyze) with the voxels in another file; a DICOM series of slices, whose files make up a folder or lie in one with
/// others, when `path` is one of them; DICOM files of many frames, and segmentations, whose value is the number of the
/// segment. Slices are sorted by where they lie, rescaled as they say, and refused (InvalidInput) unless they fill a
/// regular grid.
///
/// Throws ReadError (missing, a directory, unreadable), InvalidInput (content: not such a file, fewer voxels in the
/// file than its header claims, values that are not finite, axes that span no volume), Unsupported (extension, voxels
/// in another file, what needs ITK in a build without it, several numbers per voxel, whole numbers that float cannot hold).
LoadedImage read_image(const std::filesystem::path& path);

/// The same from memory; `source` names the content in messages and tells its format by its ending.
LoadedImage parse_image(std::string_view content, const std::string& source);

}  // namespace vmesh
