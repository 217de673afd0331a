#pragma once

#include "vmesh/surface/generate.h"

namespace vmesh {

/// Nodes of the original in numbers of the simplified centerline; kNone for those left out.
std::vector<Index> numbers_in(const SimplifiedCenterline& simplified, std::size_t original_nodes);

}  // namespace vmesh
