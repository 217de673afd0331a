#pragma once

#include "solid/layer_stack.h"
#include "solid/wedge_jacobian.h"

namespace vmesh {

/// The wedge of layer `layer` (0: at the wall) over face `f` of the wall. Its base is on the inner side.
inline WedgeCorners wedge_corners(const WallFrame& frame, const LayerStack& stack, Index f, std::size_t layer) {
  double below = stack.level[layer], above = stack.level[layer + 1];
  if (stack.side == LayerSide::inside) std::swap(below, above);
  WedgeCorners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = stack.at(frame, frame.faces[f][i], below);
    corners[i + 3] = stack.at(frame, frame.faces[f][i], above);
  }
  return corners;
}

/// Whether the layers over a face are well-shaped: their cells turn over nowhere, narrow towards the last layer by no
/// more than a fixed share, and end in a triangle that is not much worse than the wall's.
bool is_well_shaped(const WallFrame& frame, const LayerStack& stack, Index f);

}  // namespace vmesh
