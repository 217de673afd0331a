// Files that give a radius per vessel, not per point; internal to the module.
#pragma once

#include <vector>

#include "vmesh/centerline/raw_centerline.h"

namespace vmesh::io {

/// Gives the nodes of `raw` radii, where every segment has one of its own. A node has that of the second thickest of
/// its segments, which is the thinner one of the two that go through; an end that of its only one. Where a node is
/// thicker or thinner than a segment at it, the segment gets a node more, one radius of that node away or in its
/// middle, from which on it has its own radius: the change lies within the vessel that it branches from.
void set_radii_of_segments(RawCenterline& raw, const std::vector<double>& radius);

}  // namespace vmesh::io
