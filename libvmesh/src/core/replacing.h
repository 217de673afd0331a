// What files and folders that are written under a temporary name have in common. Internal to the module.
#pragma once

#include <filesystem>

namespace vmesh {

/// The target of `path` through all its links, whether it exists or not.
std::filesystem::path behind_links(std::filesystem::path path);

/// A name in the same folder that cannot be guessed. Throws WriteError.
std::filesystem::path temporary_name(const std::filesystem::path& path);

/// So that a crash of the machine does not undo the rename. Some file systems do not support it; that is not an error.
void sync_folder(const std::filesystem::path& folder);

}  // namespace vmesh
