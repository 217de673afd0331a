#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// The verbs that document the others.
struct HelpArguments {
  std::string shell;
  std::string verb;
  std::filesystem::path folder;
};

void add_help(CLI::App& app, HelpArguments& arguments);

/// Throws UsageError for a first word that is not a verb, suggesting the nearest one and listing all.
void check_verb(const CLI::App& app, std::string_view word);

/// Runs one of these verbs if it was called; returns whether it was.
bool ran_help(const CLI::App& app, const HelpArguments& arguments);

}  // namespace vmesh::tool
