#pragma once

#include "vmesh/skeleton/extract_centerline.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// Refuses options for images where the input is none (UsageError).
void check_extraction(const InputArguments& input, const ReferenceOptions& image);

/// The centerline of an image's vessels, or of a wall; what happened is logged.
ExtractedCenterline extract(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options,
                            Console& console);

}  // namespace vmesh::tool
