#pragma once

#include <string>

#include "vmesh/reference/reference_surface.h"
#include "vmesh/skeleton/extract_centerline.h"

#include "command_line/console.h"

namespace vmesh::tool {

/// Logs what extraction found, and warns of what it left out or changed.
void log_extraction(const ExtractedCenterline& extracted, Console& console);

/// "--label 2 --spacing 1 ...": how voxels are chosen and prepared.
std::string describe(const ReferenceOptions& image);
/// "--step 1 --join 1 ...", likewise.
std::string describe(const ExtractOptions& options);

}  // namespace vmesh::tool
