#pragma once

#include <utility>
#include <vector>

#include "vmesh/volume/cone_relations.h"

namespace vmesh {

/// Pairs of cones, the lower number first, ascending, that are not local to each other, but one of them must be known
/// where the other is: the rounding between it and a third cone, local to both, reaches the other's wall. So it is
/// where a thin vessel leaves two thick ones within the rounding between them; unless both are local to it, the
/// boundary has a step where it begins.
std::vector<std::pair<Index, Index>> rounded_over(const ConeRelations& relations);

}  // namespace vmesh
