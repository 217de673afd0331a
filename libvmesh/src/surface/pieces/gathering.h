#pragma once

#include "surface/pieces/piece.h"
#include "surface/proof/finished_surface.h"

namespace vmesh {

/// A surface put together from its pieces: vertices of the seams first, then those of the pieces in their order.
struct GatheredSurface : FinishedSurface {
  std::vector<Index> first_face;  ///< of every piece, then the total

  Index piece_of(Index face) const;
};

GatheredSurface gather(const VesselRings& tubes, const Division& division, const std::vector<PieceSurface>& pieces);

}  // namespace vmesh
