// Headers of image files, internal to the module: one parser per format. Parsers take the file's first bytes and its
// name for messages, and throw like read_image().
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/text.h"
#include "vmesh/core/types.h"
#include "vmesh/image/image_io.h"

#include "number_type.h"

namespace vmesh::image {

struct ImageHeader {
  std::array<std::uint64_t, 3> size = {0, 0, 0};        ///< none is 0, and their product does not overflow
  Vec3 origin = Vec3::Zero();                           ///< LPS, mm
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();  ///< as in VoxelImage
  NumberType type = NumberType::u8;
  bool big_endian = false;
  double slope = 1, intercept = 0;  ///< value = slope * stored + intercept
  std::string data_file;            ///< with the voxels, as the header names it; empty: they follow the header
  std::uint64_t data_begin = 0;     ///< bytes before the voxels
  bool data_at_end = false;         ///< instead, the voxels are the last bytes of the file
  bool packed = false;              ///< compressed by zlib or gzip from there on
  std::uint64_t layers = 1;         ///< numbers stored for every voxel, side by side; no more than kMostLayers
  std::vector<ImageSegment> segments;
  std::vector<std::string> warnings;

  static constexpr std::uint64_t kMostLayers = 1000;

  std::uint64_t voxels() const { return size[0] * size[1] * size[2]; }
};

ImageHeader parse_nifti_header(std::string_view bytes, const std::string& name);
ImageHeader parse_nrrd_header(std::string_view bytes, const std::string& name);
ImageHeader parse_meta_header(std::string_view bytes, const std::string& name);

/// Sets the size from a file's list of sizes: three, and more only if the others are 1.
void set_size(ImageHeader& header, const std::vector<double>& sizes, const std::string& name);

/// Throws InvalidInput if the axes are not finite or span no volume.
void check_place(const Vec3& origin, const Eigen::Matrix3d& steps, const std::string& name);

/// `given`, the name of the file with the voxels. Throws Unsupported if it is a list or a pattern of many.
std::string one_data_file(std::string_view given, const std::string& name);

/// Sets where the voxels begin: `skipped` bytes after `from`, or, if that is -1, as many before the end as they need.
/// Throws InvalidInput citing `key` if it is no such number, Unsupported if the voxels are compressed.
void set_data_begin(ImageHeader& header, std::uint64_t from, std::string_view skipped, const std::string& name,
                    std::string_view key);

/// The other file of a NIfTI or Analyze pair: with this extension, in upper case if that of `path` is.
std::filesystem::path other_of_pair(std::filesystem::path path, const char* lower, const char* upper);

/// Numbers separated by blanks, commas and brackets. Throws InvalidInput citing `key`.
std::vector<double> numbers_in(std::string_view text, const std::string& name, std::string_view key);

/// Without blanks at its ends, in lower case.
std::string folded(std::string_view text);

/// `text` in quotes, on one line and shortened for a message.
std::string cited(std::string_view text);

/// "the segments are "portal" (1) and "hepatic" (2)", for messages.
std::string list_of(const std::vector<ImageSegment>& segments);

/// Removes the next line from `text`, without its end. False if nothing is left. The last line need not have an end.
bool take_line(std::string_view& text, std::string_view& line);

}  // namespace vmesh::image
