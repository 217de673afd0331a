// Shells within shells, internal to the module.
#pragma once

#include <string>
#include <vector>

#include "openings.h"

namespace vmesh::skeleton {

/// Leaves out outer surfaces of walls with a thickness, cavities, and what has almost no volume. `shells` are closed
/// and outward; they come out by volume, largest first. What was left out is appended to `notes`.
void keep_lumens(std::vector<Shell>& shells, std::vector<std::string>& notes);

}  // namespace vmesh::skeleton
