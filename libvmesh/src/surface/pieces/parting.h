#pragma once

#include "surface/pieces/gathering.h"

namespace vmesh {

/// What a surface was like where walls were parted.
struct BeforeParting {
  std::vector<Index> vertex, face;  ///< those that may have changed
  std::vector<FinishedVertex> old_vertex;
  std::vector<Triangle> old_face;
  std::size_t vertices = 0, faces = 0;  ///< in all
};

/// Parts walls of finished pieces that cross each other: edges of such faces are flipped or split, or their vertices
/// moved back onto the boundary, wherever one such step is enough and leaves no bad triangle. `crossings` are the pairs
/// of faces that cross. Vertices and faces keep their numbers; new ones come last. Returns the pairs that still cross.
/// `before`, if not null, is filled in.
std::vector<std::pair<Index, Index>> part_walls(GatheredSurface& surface, const VesselField& field,
                                                const std::vector<std::pair<Index, Index>>& crossings,
                                                BeforeParting* before = nullptr);

/// Undoes it, if anything was parted.
void take_back(const BeforeParting& before, GatheredSurface& surface);

}  // namespace vmesh
