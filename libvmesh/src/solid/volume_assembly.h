#pragma once

#include <optional>

#include "solid/core.h"
#include "solid/layer_stack.h"

namespace vmesh {

/// What a volume mesh is made of. Either stack may be without layers.
struct VolumeParts {
  const VesselWall* wall = nullptr;
  const WallFrame* frame = nullptr;
  LayerStack layers, shell;
  Core bridges;  ///< between the shells of different places, see bridge_walls()
  bool with_lumen = true;
};

/// The surface that is left for the core: where layers end, and the caps within their rings. Vertices of the wall
/// first, in the frame's numbers.
CoreSurface core_surface(const WallFrame& frame, const LayerStack& layers, double core_size);

/// The mesh. `core`: of `surface`, which is core_surface() of the layers, with their ends (take_layer_ends()).
VolumeMesh assemble(const VolumeParts& parts, const CoreSurface& surface, const Core& core);

}  // namespace vmesh
