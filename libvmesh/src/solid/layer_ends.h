#pragma once

#include "solid/core.h"
#include "solid/layer_stack.h"

namespace vmesh {

/// Whether layers end at two of the corners of a face: what is left of wedges over it are tetrahedra, as flat as those
/// are thin.
bool is_layer_end(const LayerStack& layers, const Triangle& face);

/// Makes the tetrahedra over such faces part of the core, which then can be improved there too. To be called once, with
/// a core as it was filled.
void take_layer_ends(const WallFrame& frame, const LayerStack& layers, CoreSurface& surface, Core& core);

}  // namespace vmesh
