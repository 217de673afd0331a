#pragma once

#include "solid/core.h"
#include "solid/layer_stack.h"

namespace vmesh {

/// Tetrahedra between shells that meet, so that they are one wall: outside of both, nowhere farther from a lumen than
/// the wall's thickness there, sharing faces with the shells. Corners: numbers of vertices of the wall, which stand for
/// the outermost points of the shell over them, then added points. Throws Unsupported without TetGen.
Core bridge_walls(const WallFrame& frame, const LayerStack& shell);

/// The outside of bridges.
struct BridgeFaces {
  std::vector<char> is_bridged;  ///< of every face of the wall: the shell over it has a bridge on its outside
  std::vector<Triangle> free;  ///< the other faces of bridges that belong to one alone, counter-clockwise from outside
};
BridgeFaces faces_of_bridges(const WallFrame& frame, const Core& bridges);

/// Bridges that hang together.
std::vector<MergedPlace> merged_places(const WallFrame& frame, const LayerStack& shell, const Core& bridges);

}  // namespace vmesh
