#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// The verbs that tell of the others.
struct HelpArguments {
  std::string shell;
  std::string verb;
  std::filesystem::path folder;
};

void add_help(CLI::App& app, HelpArguments& arguments);

/// Throws UsageError for a first word that is not a verb: with the one that was meant, perhaps, and all.
void check_verb(const CLI::App& app, std::string_view word);

/// Whether one of these verbs was called; then it is done.
bool ran_help(const CLI::App& app, const HelpArguments& arguments);

}  // namespace vmesh::tool
