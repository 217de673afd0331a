#pragma once

#include <vector>

#include "solid/layer_stack.h"

namespace vmesh {

/// For every vertex of the wall, whether the layers there, made `stack.reach` times as thick, would run into those of
/// another place, into the wall or into a cap. Only layers at vertices that `has_changed` are tested against all
/// others. Exact predicates.
std::vector<char> vertices_without_room(const WallFrame& frame, const LayerStack& stack,
                                        const std::vector<char>& has_changed);

}  // namespace vmesh
