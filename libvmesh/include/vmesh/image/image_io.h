#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/image/voxel_image.h"

namespace vmesh {

/// Whether the name has an image's extension, .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd, .hdr, .img or .dcm, in upper or
/// lower case.
bool is_image_path(const std::filesystem::path& path);

/// The same, or a DICOM file of any name, or a folder with such files. Does not wait for pipes.
bool is_image(const std::filesystem::path& path);

struct LoadedImage {
  VoxelImage image;
  bool integer = false;               ///< the file stores whole numbers: labels, a mask or CT numbers
  std::vector<std::string> warnings;  ///< what was assumed because the file does not say
};

/// Reads a scalar image of three dimensions (more if the others have one sample), placed in space as in 3D Slicer:
/// NIfTI-1 and -2, NRRD, MetaImage, compressed or not, with header and voxels in one file or two, and Analyze. Of two,
/// either is given of a NIfTI or Analyze pair (.hdr and .img), else the header (.nhdr, .mhd), which names the other
/// relative to its own folder. In NIfTI, the sform takes precedence over the qform unless it is skewed. Needs at most
/// 16 times the memory of the file's uncompressed voxels (and 128 times that of an uncompressed file) plus a megabyte,
/// whatever the header says.
///
/// A build with GDCM also reads, in a child process and after checking for memory, a DICOM series of slices, given by
/// its folder or by one of its files; multi-frame DICOM files, and segmentations, whose values are segment numbers.
/// Slices are sorted by position, rescaled as their headers say, and refused (InvalidInput) unless they fill a regular
/// grid.
///
/// Throws ReadError (missing, a directory, unreadable, the second of two files as well), InvalidInput (content: not
/// such a file, fewer voxels in the file than its header claims, values that are not finite, axes that span no volume),
/// Unsupported (extension, voxels in many files, DICOM in a build without GDCM, several numbers per voxel, integers
/// that float cannot represent).
LoadedImage read_image(const std::filesystem::path& path);

/// The same from memory; `source` names the content in messages, and its extension gives the format. Throws Unsupported
/// if the voxels are in another file.
LoadedImage parse_image(std::string_view content, const std::string& source);

}  // namespace vmesh
