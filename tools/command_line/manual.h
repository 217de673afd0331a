#pragma once

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>

namespace vmesh::tool {

/// A manual page (roff, for man) from the same text as --help: of the command itself, vmesh(1), without `verb`; of a
/// verb, vmesh-VERB(1), with it.
std::string manual_page(const CLI::App& app, const CLI::App* verb = nullptr);

/// All pages as vmesh.1, vmesh-generate.1, ... in a folder, which must exist. Throws WriteError.
void write_manual_pages(const CLI::App& app, const std::filesystem::path& folder);

}  // namespace vmesh::tool
