#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/surface/generate.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// Grows the surface of `field` piece by piece and fills in mesh, binding, radii, openings, growth and warnings of the
/// result, and the error where there is a limit. `open` says for every node whether the surface is to be open there.
/// Walls of different pieces that cross each other are parted in place. Where that fails, or where pieces are not sound
/// at their seam, they are made again as one. Returns the pairs of faces that still intersect.
std::vector<std::pair<Index, Index>> grow_pieces(const VesselField& field, const std::vector<char>& open,
                                                 const GenerateOptions& options, const Progress& progress,
                                                 GenerateResult& result);

}  // namespace vmesh
