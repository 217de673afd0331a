#pragma once

#include "vmesh/skeleton/extract_centerline.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// Refuses options for images where the input is none (UsageError).
void check_extraction(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options);

/// The centerline of an image's vessels, or of a wall; what happened is logged, and the times of the stages appended.
ExtractedCenterline extract(const InputArguments& input, const ReferenceOptions& image, const ExtractOptions& options,
                            std::vector<StageTime>& stages, Console& console);

/// Whether the coverage is as required; warns if not.
bool meets(const RequiredCoverage& required, const ExtractionReport& report, Console& console);

}  // namespace vmesh::tool
