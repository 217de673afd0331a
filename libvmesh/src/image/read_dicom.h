// DICOM images, internal to the module.
#pragma once

#include <filesystem>

#include "vmesh/image/image_slices.h"

namespace vmesh::image {

/// See read_image_slices(). Throws Unsupported in a build without GDCM.
void read_dicom(const std::filesystem::path& path, const ImageBegin& begin, const SliceVisitor& visit);

}  // namespace vmesh::image
