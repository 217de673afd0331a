// Options for images and walls, and for what is made of them.
#pragma once

#include <CLI/CLI.hpp>

#include "vmesh/skeleton/extract_centerline.h"

#include "command_line/arguments.h"

namespace vmesh::tool {

/// Adds options for making a surface from an image.
void add_image_options(CLI::App& verb, ReferenceOptions& options);

/// Adds options for extracting a centerline.
void add_extraction(CLI::App& verb, ExtractOptions& options);

/// Adds --require for what extraction has to cover.
void add_required_coverage(CLI::App& verb, RequiredCoverage& required);

/// Adds options for the target and the parameters of a fit.
void add_fitting(CLI::App& verb, FittingArguments& arguments);

}  // namespace vmesh::tool
