#pragma once

#include "command_line/arguments.h"
#include "command_line/console.h"
#include "command_line/inputs.h"

namespace vmesh::tool {

/// Options that only an image or a reference gives a meaning to are refused where there is none (UsageError).
void check_input(const GenerateArguments& arguments);

/// With a reference, a budget is the fit's: of vertices or of the distance to the reference.
void apply_budget_to_fit(GenerateArguments& arguments);

/// Where the surface to fit to is from; empty if there is none.
std::filesystem::path fit_reference(const GenerateArguments& arguments);

/// What `vmesh generate` starts from.
struct GenerateInput {
  LoadedCenterline centerline;       ///< clean
  std::optional<TriMesh> reference;  ///< to fit to
};

/// Reads the centerline, or extracts it from an image, and the reference.
GenerateInput load_input(const GenerateArguments& arguments, Console& console);

}  // namespace vmesh::tool
