#pragma once

#include "surface/pieces/gathering.h"

namespace vmesh {

/// Parts walls of finished pieces that cross each other: edges of such faces are flipped or split, or their vertices
/// moved back onto the boundary, wherever one such step is enough and leaves no bad triangle. `crossings` are the pairs
/// of faces that cross. Vertices and faces keep their numbers; new ones come last. Returns the pairs that still cross.
std::vector<std::pair<Index, Index>> part_walls(GatheredSurface& surface, const VesselField& field,
                                                const std::vector<std::pair<Index, Index>>& crossings);

}  // namespace vmesh
