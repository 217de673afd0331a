// Images read through ITK and its GDCM, internal to the module.
#pragma once

#include <filesystem>

#include "vmesh/image/image_io.h"

namespace vmesh::image {

/// See read_image(). Throws Unsupported in a build without ITK.
LoadedImage read_by_itk(const std::filesystem::path& path);

}  // namespace vmesh::image
