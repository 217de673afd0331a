#pragma once

#include "surface/pieces/piece.h"
#include "surface/remesh/bound_surface.h"

namespace vmesh {

/// What keeps a piece from being sound, and how good it is.
struct PieceFindings {
  std::vector<PieceFault> faults;
  double worst_skewness = 0;  ///< equiangle
};

/// Faults are faces that cross each other, nearly degenerate faces, and nodes of `nodes` that are not inside; for the
/// last, lids close open ends and seams. `may_cross`: false if it is known that no faces cross.
PieceFindings check_piece(BoundSurface& surface, const std::vector<Index>& nodes, const GenerateOptions& options,
                          bool may_cross);

}  // namespace vmesh
