#pragma once

#include "surface/pieces/piece.h"
#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// What keeps a piece of surface from being sound: faces that cross each other, faces that lie the wrong way up or are
/// degenerate nearly, vertices that did not reach their wall, and nodes among `nodes` that are not inside. Open ends
/// and seams count as closed by their lids for the last. Without
/// `may_cross` it is known that no faces cross.
std::vector<PieceFault> find_faults(BoundSurface& surface, const std::vector<Index>& nodes,
                                    const GenerateOptions& options, bool may_cross);

}  // namespace vmesh
