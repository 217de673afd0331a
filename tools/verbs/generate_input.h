#pragma once

#include "command_line/console.h"
#include "command_line/inputs.h"
#include "verbs/generate_arguments.h"

namespace vmesh::tool {

/// Refuses options that only apply to an image or a reference where there is none (UsageError).
void check_input(const GenerateArguments& arguments);

/// With a reference, a budget applies to the fit: vertices, or distance to the reference.
void apply_budget_to_fit(GenerateArguments& arguments);

/// The file of the surface to fit to; empty if there is none.
std::filesystem::path fit_reference(const GenerateArguments& arguments);

/// The input of `vmesh generate`.
struct GenerateInput {
  LoadedCenterline centerline = {{Centerline({{Vec3::Zero(), 1}}, {}), {}, {}, {}, {}}, {}, {}};  ///< clean
  std::optional<TriMesh> reference;                                                               ///< to fit to
  std::optional<ExtractionReport> extraction;  ///< if the centerline was extracted
  std::vector<StageTime> stages;               ///< read, and those of extraction
};

/// Reads the centerline, or extracts it from an image or a wall, and the reference.
GenerateInput load_input(const GenerateArguments& arguments, Console& console);

}  // namespace vmesh::tool
