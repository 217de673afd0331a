#pragma once

#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Where a vessel is cut: the flat cross-section at an end of a centerline.
struct EndSection {
  Index node = kNone;           ///< of the centerline, in the middle of the cross-section
  Vec3 center = Vec3::Zero();   ///< centroid of the area, mm
  Vec3 normal = Vec3::Zero();   ///< unit, out of the vessel
  double area = 0;              ///< mm^2
  std::vector<Vec3> ring;       ///< its boundary, counter-clockwise about the normal, mm; empty: unknown
  bool open = false;            ///< the wall was open there; else it was closed by a flat cap, or cut by an image's border
};

}  // namespace vmesh
