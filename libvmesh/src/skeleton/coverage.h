// How far a wall is from vessels, and where none reaches it, internal to the module.
#pragma once

#include <vector>

#include "vmesh/skeleton/extract_centerline.h"

#include "cone_fit.h"

namespace vmesh::skeleton {

/// Fills in the report's distances, coverage and missed regions. `left_out`: of every sample, whether its component
/// was. `voxel`: mm; 0 if the wall is not made of voxels.
void measure_coverage(const Centerline& centerline, const FitSamples& samples, const std::vector<bool>& left_out,
                      double voxel, ExtractionReport& report);

}  // namespace vmesh::skeleton
