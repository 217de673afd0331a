// Images that ITK and its GDCM read, internal to the module.
#pragma once

#include <filesystem>

#include "vmesh/image/image_io.h"

namespace vmesh::image {

/// As read_image() has it. Throws Unsupported in a build without ITK.
LoadedImage read_by_itk(const std::filesystem::path& path);

}  // namespace vmesh::image
