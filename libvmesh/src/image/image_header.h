// Headers of image files, internal to the module: one parser per format. Parsers take the file's first bytes and its
// name for messages, and throw like read_image().
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/core/types.h"

#include "number_type.h"

namespace vmesh::image {

struct ImageHeader {
  std::array<std::uint64_t, 3> size = {0, 0, 0};        ///< none is 0, and their product does not overflow
  Vec3 origin = Vec3::Zero();                           ///< LPS, mm
  Eigen::Matrix3d steps = Eigen::Matrix3d::Identity();  ///< as in VoxelImage
  NumberType type = NumberType::u8;
  bool big_endian = false;
  double slope = 1, intercept = 0;  ///< value = slope * stored + intercept
  std::uint64_t data_begin = 0;     ///< bytes before the voxels
  bool packed = false;              ///< compressed by zlib or gzip from there on
  std::vector<std::string> warnings;

  std::uint64_t voxels() const { return size[0] * size[1] * size[2]; }
};

/// Whether the name has the extension of a format that is parsed here; other formats are read through ITK.
bool has_own_format(const std::filesystem::path& path);

ImageHeader parse_nifti_header(std::string_view bytes, const std::string& name);
ImageHeader parse_nrrd_header(std::string_view bytes, const std::string& name);
ImageHeader parse_meta_header(std::string_view bytes, const std::string& name);

/// Sets the size from a file's list of sizes: three, and more only if the others are 1.
void set_size(ImageHeader& header, const std::vector<double>& sizes, const std::string& name);

/// Throws InvalidInput if the axes are not finite or span no volume.
void check_place(const ImageHeader& header, const std::string& name);

/// Numbers separated by blanks, commas and brackets. Throws InvalidInput citing `key`.
std::vector<double> numbers_in(std::string_view text, const std::string& name, std::string_view key);

/// `text` trimmed and in lower case.
std::string folded(std::string_view text);

/// `text` in quotes, on one line and shortened for a message.
std::string cited(std::string_view text);

/// Removes the next line from `text`, without its end. False if there is no complete line.
bool take_line(std::string_view& text, std::string_view& line);

}  // namespace vmesh::image
