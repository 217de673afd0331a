#pragma once

#include "vmesh/tuning/budget.h"

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// Whether any of --label, --threshold, --spacing, --smooth is given.
bool has_options(const ReferenceOptions& image);
/// Refuses them for an input that is no image (UsageError).
void check_options_of_image(const std::filesystem::path& input, const ReferenceOptions& image);

/// Applies a budget to a fit. Budgets of time, or of an error in radii, are refused (UsageError).
void set_budget(const Budget& budget, FitOptions& options);

/// The surface to fit to: from a file, or contoured from an image. Options that do not apply are refused (UsageError).
TriMesh load_fit_reference(const FittingArguments& arguments, Console& console);

}  // namespace vmesh::tool
