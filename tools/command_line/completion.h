#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// A bash script that completes verbs, options, their values, and file names.
std::string bash_completion(const CLI::App& app);

/// The choices of an option, from "TEXT:{um,mm,cm,m}"; none for other options.
std::vector<std::string> choices_of(const CLI::Option& option);

/// All names of an option as typed: "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option);

}  // namespace vmesh::tool
