#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// A script for bash that completes verbs, options, the words an option takes, and names of files.
std::string bash_completion(const CLI::App& app);

/// The words that an option takes one of, from "TEXT:{um,mm,cm,m}"; none for other options.
std::vector<std::string> choices_of(const CLI::Option& option);

/// All names of an option as they are typed: "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option);

}  // namespace vmesh::tool
