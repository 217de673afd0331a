#pragma once

#include <vector>

#include "vmesh/fit/fit_surface.h"

#include "fit/correspondence.h"

namespace vmesh {

/// Parts of the reference that the packed surface is farther from than half of the local radius; largest first.
std::vector<UnmatchedPart> uncovered_parts(const FitMesh& surface, const FitReference& reference,
                                           const VesselField& field);

/// Parts of the packed surface that the reference is farther from than half of the local radius; largest first.
std::vector<UnmatchedPart> unsupported_parts(const FitMesh& surface, const FitReference& reference,
                                             const VesselField& field);

}  // namespace vmesh
