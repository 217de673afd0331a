// Flat caps that a closed wall has, internal to the module.
#pragma once

#include "openings.h"

namespace vmesh::skeleton {

/// Appends the flat caps of a closed shell to its ends and marks their faces: flat patches, round, with a sharp edge
/// all around, that close a tube of about their size. `caps`: counts them.
void find_flat_caps(Shell& shell, std::size_t& caps);

}  // namespace vmesh::skeleton
