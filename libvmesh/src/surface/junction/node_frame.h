#pragma once

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A frame that turns with the centerline: along the node's first segment, and as far as possible from its others; then
/// turned to where no segment runs through a vertex or a mirror plane of what is laid out in it, so that nothing hangs
/// on rounding.
Eigen::Matrix3d frame_at(const Centerline& centerline, Index node);

}  // namespace vmesh
