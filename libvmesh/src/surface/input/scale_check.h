#pragma once

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// Refuses lengths whose powers a double does not hold, and radii that its digits do not resolve beside the
/// coordinates. Throws InvalidInput that names the node.
void check_scale(const Centerline& centerline);

}  // namespace vmesh
