// Verbs as modules of 3D Slicer, by its execution model: a description of the options in XML, from which Slicer makes a
// panel, and tags on stdout that tell of progress.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// With it, a call comes from Slicer.
inline constexpr const char* kSlicerFlag = "--slicer";

/// The description of a verb, as the execution model has it.
std::string execution_model(const CLI::App& verb);

/// The words that a user would have typed for what Slicer calls: in names of options - for _, which the model demands,
/// and without the options that have their defaults, as Slicer passes all numbers and choices. Without kSlicerFlag
/// among `words`, the first of which is the program, they stay as they are.
std::vector<std::string> without_defaults(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace vmesh::tool
