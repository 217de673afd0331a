#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vmesh/image/image_io.h"
#include "vmesh/image/voxel_image.h"

namespace vmesh {

/// What is known of an image before its voxels are read.
struct ImageFrame {
  VoxelImage frame;                         ///< its size and place, without values
  bool integer = false;                     ///< the file stores whole numbers: labels, a mask or CT numbers
  std::vector<std::string> warnings;        ///< what was assumed because the file does not say
  std::vector<ImageSegment> segments = {};  ///< that the file names
};

/// Reads an image like read_image(), but hands it over slice by slice, in the memory of two slices and two megabytes,
/// however large it is and whether or not it is compressed. DICOM is first read as a whole. Passes on what `begin` and
/// `visit` throw; nothing more is read then.
///
/// Throws like read_image(). What can be told from the header and the size of the file is thrown before `begin` is
/// called; that a compressed file holds less than it claims, or values that are not finite, only on reaching the place.
void read_image_slices(const std::filesystem::path& path, const ImageBegin& begin, const SliceVisitor& visit,
                       const ImageReadOptions& options = {});

/// The same from the content of a file; like parse_image().
void parse_image_slices(std::string_view content, const std::string& source, const ImageBegin& begin,
                        const SliceVisitor& visit, const ImageReadOptions& options = {});

/// The same from an image in memory.
void visit_slices(const VoxelImage& image, const SliceVisitor& visit);

}  // namespace vmesh
