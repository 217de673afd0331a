#pragma once

#include <filesystem>

#include "command_line/console.h"
#include "verbs/scene.h"

namespace vmesh::tool {

/// What a page that moves begins with: the material, the options and what is held of a script, if any. Throws
/// InvalidInput naming the script for what such pages have not; tells the console what is left out.
Scene live_scene(const std::filesystem::path& script, const Centerline& centerline, Console& console);

}  // namespace vmesh::tool
