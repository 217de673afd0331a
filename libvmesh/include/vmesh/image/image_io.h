#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/file_format.h"
#include "vmesh/image/voxel_image.h"

namespace vmesh {

namespace image {
struct ImageHeader;
}

/// What to read of an image, and what its file does not tell.
struct ImageReadOptions {
  std::vector<std::string> segments = {};         ///< by name
  std::vector<double> labels = {};                ///< segments by value
  std::optional<Vec3> voxel_size = std::nullopt;  ///< TIFF: sides of a voxel, mm; overrides the file
};

struct ImageFrame;
/// Called once, before the first slice.
using ImageBegin = std::function<void(const ImageFrame& image)>;

/// Called with slice k (along the third axis) in ascending order: size[0] * size[1] values, the first axis fastest,
/// valid during the call only.
using SliceVisitor = std::function<void(std::size_t k, std::span<const float> values)>;

/// A format of images.
struct ImageFormat {
  std::string name;
  std::vector<std::string> extensions;     ///< lower case, with their dots
  std::vector<std::string> of_parts = {};  ///< of files that are only a part of an image, and lead to it
  bool in_two_files = false;               ///< header and voxels
  std::size_t header_bytes = 0;            ///< that `parse_header` needs at most
  bool compressed_whole = false;           ///< by gzip, if the name ends with .gz
  std::vector<std::string> options = {};   ///< of ImageReadOptions, those that act on it besides the segments
  OptionalPart needs = {};                 ///< what `read` needs
  /// From the first bytes of a file that `source` names in messages; null for what libraries read: DICOM, and TIFF.
  image::ImageHeader (*parse_header)(std::string_view bytes, const std::string& source) = nullptr;

  /// By a library, of the file that `source` names, or of its content if that is given: see read_image_slices().
  void (*read)(const std::string& source, std::optional<std::string_view> content, const ImageBegin& begin,
               const SliceVisitor& visit, const ImageReadOptions& options) = nullptr;

  /// Images are only read.
  static bool is_written() { return false; }
};

/// All formats. Adding one: see CONTRIBUTING.md.
const std::vector<ImageFormat>& image_formats();

/// ".nii, .nii.gz, ... or a folder of DICOM files", for messages.
std::string listed_image_extensions();

/// Whether the name has an image's extension, upper or lower case.
bool is_image_path(const std::filesystem::path& path);

/// The same, or a DICOM file of any name, or a folder with such files. Does not wait for pipes.
bool is_image(const std::filesystem::path& path);

/// Whether ImageReadOptions::voxel_size acts on a file of this name.
bool takes_voxel_size(const std::filesystem::path& path);

/// A segment of a segmentation, as 3D Slicer stores them (.seg.nrrd): the voxels of a value in a layer. Segments that
/// overlap are in layers of their own.
struct ImageSegment {
  std::string name;
  double value = 1;
  std::size_t layer = 0;
};

/// The values of the segments of these names, in any case. Throws InvalidInput, listing the segments.
std::vector<double> values_of(const std::vector<std::string>& names, const std::vector<ImageSegment>& segments);

struct LoadedImage {
  VoxelImage image;
  bool integer = false;                     ///< the file stores whole numbers: labels, a mask or CT numbers
  std::vector<std::string> warnings;        ///< what was assumed because the file does not say
  std::vector<ImageSegment> segments = {};  ///< that the file names
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
/// Of a NRRD file with several layers of segments, voxels have the value of the chosen segment that they are in, or 0;
/// without a choice it is refused. A build with libtiff also reads TIFF, pages being slices.
///
/// Throws ReadError (missing, a directory, unreadable, the second of two files as well), InvalidInput (content: not
/// such a file, fewer voxels in the file than its header claims, values that are not finite, axes that span no volume),
/// Unsupported (extension, voxels in many files, DICOM in a build without GDCM, several numbers per voxel, integers
/// that float cannot represent).
LoadedImage read_image(const std::filesystem::path& path, const ImageReadOptions& options = {});

/// The same from memory; `source` names the content in messages, and its extension gives the format. Throws Unsupported
/// if the voxels are in another file.
LoadedImage parse_image(std::string_view content, const std::string& source, const ImageReadOptions& options = {});

}  // namespace vmesh
