#pragma once

#include <vector>

#include "solid/layer_stack.h"

namespace vmesh {

/// For every vertex of the wall, whether the layers there, made `reach` times as thick, would run into those of another
/// place, into the wall or into a cap. Exact predicates.
std::vector<char> vertices_without_room(const WallFrame& frame, const LayerStack& stack, double reach);

}  // namespace vmesh
