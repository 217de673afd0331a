// For files that give a radius per vessel, not per point; internal to the module.
#pragma once

#include <vector>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::io {

/// Sets the radii of the nodes of `raw` from those of the segments. A node gets that of its second thickest segment,
/// the thinner of the two that run through it; an end that of its only one. Where that differs from a segment's radius,
/// the segment gets an additional node, one radius of that node away or at its midpoint, from which on it has its own
/// radius: so the change lies within the vessel that it branches from.
void set_radii_of_segments(RawCenterline& raw, const std::vector<double>& radius);

}  // namespace vmesh::io
