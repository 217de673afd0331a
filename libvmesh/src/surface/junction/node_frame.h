#pragma once

#include "vmesh/centerline/centerline.h"

namespace vmesh {

/// A frame that rotates with the centerline: aligned with the node's first segment and as far as possible from its
/// others, then rotated so that no segment runs through a vertex or mirror plane of a lattice or sphere laid out in it;
/// otherwise rounding would decide.
Eigen::Matrix3d frame_at(const Centerline& centerline, Index node);

}  // namespace vmesh
