#pragma once

#include <vector>

#include "vmesh/fit/fit_surface.h"

#include "fit/correspondence.h"

namespace vmesh::fitting {

/// For every face of the reference, whether it belongs to a component that lies apart: less than half of its samples
/// have a match on the surface.
std::vector<char> faces_apart(const Matches& matches, const std::vector<ReferenceSample>& samples,
                              const FitReference& reference);

/// Parts of the reference that the packed surface is farther from than half of the local radius; largest first.
std::vector<UnmatchedPart> uncovered_parts(const FitMesh& surface, const FitReference& reference,
                                           const VesselField& field);

/// Parts of the packed surface that the reference is farther from than half of the local radius; largest first.
std::vector<UnmatchedPart> unsupported_parts(const FitMesh& surface, const FitReference& reference,
                                             const VesselField& field);

}  // namespace vmesh::fitting
