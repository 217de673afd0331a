#pragma once

#include <vector>

#include "surface/pieces/piece.h"

namespace vmesh {

/// Pieces that took more than ten times the median's time for a vertex, slowest first. `plans`: of every piece.
std::vector<SlowPiece> slow_pieces(const std::vector<PieceSurface>& pieces, const std::vector<PiecePlan>& plans,
                                   const Centerline& centerline);

}  // namespace vmesh
