#pragma once

#include <string>
#include <vector>

#include "vmesh/core/types.h"

namespace vmesh {

/// Where a vessel is cut: the flat cross-section at an end of a centerline. Lengths are in the unit of the centerline,
/// mm unless that says otherwise.
struct EndSection {
  Index node = kNone;          ///< of the centerline, in the middle of the cross-section
  Vec3 center = Vec3::Zero();  ///< centroid of the area
  Vec3 normal = Vec3::Zero();  ///< unit, out of the vessel
  double area = 0;             ///< in the square of the unit
  std::vector<Vec3> ring;      ///< its boundary, counter-clockwise about the normal; empty: unknown
  bool open = false;  ///< the wall was open there; else it was closed by a flat cap, or cut by an image's border
};

/// The first thing that is wrong with the section itself ("its area must be greater than 0"); empty if nothing is. The
/// normal need not have length 1.
std::string problem_of(const EndSection& section);

/// Radius of the circle of the section's area.
double radius_of(const EndSection& section);

}  // namespace vmesh
