#pragma once

#include "command_line/console.h"
#include "command_line/inputs.h"
#include "report/summary.h"

namespace vmesh::tool {

/// What `vmesh info` tells of an image: its kind, size, place and values, which commands could come next, problems and
/// warnings. Throws UsageError for further files.
Json describe_image(const InputArguments& input, Console& console);

}  // namespace vmesh::tool
