// TIFF stacks, through libtiff; internal to the module.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vmesh/image/image_slices.h"

namespace vmesh::image {

/// See read_image_slices(). Of the file that `source` names, or of its content if that is given.
void read_tiff(const std::string& source, std::optional<std::string_view> content, const ImageBegin& begin,
               const SliceVisitor& visit, const ImageReadOptions& options);

}  // namespace vmesh::image
