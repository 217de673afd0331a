#pragma once

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// Refuses lengths whose powers overflow a double, and radii too small to resolve beside the coordinates. Throws
/// InvalidInput that names the node.
void check_scale(const Centerline& centerline);

}  // namespace vmesh
