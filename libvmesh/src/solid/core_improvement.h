#pragma once

#include "solid/core.h"
#include "solid/core_cells.h"
#include "solid/layer_stack.h"

namespace vmesh {

/// Makes the worst tetrahedra better: moves added points, swaps edges and faces, and adds points. No tetrahedron
/// becomes worse than the worst it replaces; the surface stays as it is. Deterministic.
void improve_core(const CoreSurface& surface, Core& core);

/// Tetrahedra whose shape is worse than a limit.
struct BadPlaces {
  double least = 1;             ///< shape of any tetrahedron
  std::vector<Index> vertices;  ///< corners of bad ones, in the core's numbers; ascending
};

/// The same; and where it helps, vertices of the surface at which layers end move along their ways: the layers there
/// become thinner or thicker, as far as they stay well-shaped. Returns what is still worse than `limit`.
BadPlaces improve_core(CoreSurface& surface, Core& core, const WallFrame& frame, LayerStack& layers, double limit);

/// Makes layers over all corners of tetrahedra that are worse than `limit` thinner together, even thinner than layers
/// may else be, where that makes these better: between vertices of the wall at a crease nothing else does. No
/// tetrahedron becomes worse than the worst beside it. Last, for layers that are made thinner once more would end
/// there.
BadPlaces thin_at_bad_places(CoreSurface& surface, Core& core, const WallFrame& frame, LayerStack& layers,
                             double limit);

}  // namespace vmesh
