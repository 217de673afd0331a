#pragma once

#include "command_line/arguments.h"
#include "command_line/console.h"
#include "command_line/inputs.h"

namespace vmesh::tool {

/// Refuses options that only apply to an image or a reference where there is none (UsageError).
void check_input(const GenerateArguments& arguments);

/// With a reference, a budget applies to the fit: vertices, or distance to the reference.
void apply_budget_to_fit(GenerateArguments& arguments);

/// The file of the surface to fit to; empty if there is none.
std::filesystem::path fit_reference(const GenerateArguments& arguments);

/// The input of `vmesh generate`.
struct GenerateInput {
  LoadedCenterline centerline;       ///< clean
  std::optional<TriMesh> reference;  ///< to fit to
};

/// Reads the centerline, or extracts it from an image, and the reference.
GenerateInput load_input(const GenerateArguments& arguments, Console& console);

}  // namespace vmesh::tool
