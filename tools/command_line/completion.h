#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// Scripts that complete verbs, options, their values, folders, and files by the extensions that an option takes.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

/// The choices of an option, from "TEXT:{um,mm,cm,m}"; none for other options.
std::vector<std::string> choices_of(const CLI::Option& option);

/// All names of an option as typed: "-o", "--output".
std::vector<std::string> names_of(const CLI::Option& option);

}  // namespace vmesh::tool
