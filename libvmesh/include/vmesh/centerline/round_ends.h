#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/centerline/end_section.h"

namespace vmesh {

/// The centerline with the ends at `sections` drawn back, by up to nine tenths of their segments, so that their spheres
/// touch the plane of the section instead of reaching a radius beyond it: for a surface with round ends.
Centerline with_round_ends(const Centerline& centerline, const std::vector<EndSection>& sections);

}  // namespace vmesh
