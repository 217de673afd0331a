#pragma once

#include <filesystem>

#include "command_line/console.h"
#include "verbs/generate_arguments.h"

namespace vmesh::tool {

/// Whether the file is a part of a surface to be grown, by its name.
bool is_part(const std::filesystem::path& path);

/// Grows one: `vmesh generate part_00001.vpart`. Returns the exit code.
int run_part(const GenerateArguments& arguments, Console& console);

}  // namespace vmesh::tool
