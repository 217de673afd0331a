#pragma once

#include "surface/pieces/piece.h"
#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// What keeps a piece of surface from being sound, and what keeps it from being good.
struct PieceFindings {
  std::vector<PieceFault> faults;
  double worst_skewness = 0;  ///< equiangle
};

/// Faults are faces that cross each other, faces that are degenerate nearly, and nodes among `nodes` that are not
/// inside. Open ends and seams count as closed by their lids for the last. Without `may_cross` it is known that no
/// faces cross.
PieceFindings check_piece(BoundSurface& surface, const std::vector<Index>& nodes, const GenerateOptions& options,
                          bool may_cross);

}  // namespace vmesh
