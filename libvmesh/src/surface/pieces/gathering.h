#pragma once

#include "surface/pieces/piece.h"

namespace vmesh {

/// A surface put together from its pieces: vertices of the seams first, then those of the pieces in their order.
struct GatheredSurface {
  TriMesh mesh;
  std::vector<CenterlineBinding> binding;
  std::vector<double> radius;
  std::vector<Opening> openings;  ///< node, centre, radius and ring
  std::vector<Index> first_face;  ///< of every piece, then the total

  Index piece_of(Index face) const;
};

GatheredSurface gather(const VesselTubes& tubes, const Division& division, const std::vector<PieceSurface>& pieces);

}  // namespace vmesh
