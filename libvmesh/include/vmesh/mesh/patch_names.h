#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vmesh {

/// Whether a patch or a region can be called so in every file format: letters, digits, '_', '-' and '.', a letter
/// first, at most 60 of them.
bool is_patch_name(std::string_view name);

/// Whether a patch of this name is a wall, rather than an opening of the domain: all that begin with "wall", in upper
/// or lower case.
bool is_wall_name(std::string_view name);

/// Whether the patch with that number, from 1, is a wall: by its name; if none of the names begins with "wall", or
/// there are none, number 1 is the wall.
bool is_wall_patch(std::size_t number, const std::vector<std::string>& names);

/// Throws InvalidInput if a name is none, or differs from another one in case alone or not at all. `word` and `words`
/// name the kind in the message: "patch", "patches".
void check_patch_names(const std::vector<std::string>& names, const char* word, const char* words);

}  // namespace vmesh
