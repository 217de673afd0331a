#pragma once

#include <vector>

#include "vmesh/fit/fit_surface.h"

#include "fit/correspondence.h"
#include "fit/faces_beyond.h"

namespace vmesh::fitting {

/// For every face of the reference, whether it belongs to a component that lies apart: less than half of its samples
/// have a match on the surface.
std::vector<char> faces_apart(const Matches& matches, const std::vector<ReferenceSample>& samples,
                              const FitReference& reference);

/// Connected faces of a surface that are far from the other one, largest first.
struct FarParts {
  std::vector<UnmatchedPart> unmatched;  ///< farther somewhere than half of the local radius
  std::vector<UnmatchedPart> beyond;     ///< the others, farther than a limit
  std::vector<Index> unmatched_faces;    ///< ascending
};

/// Parts of the reference that are far from the packed surface: all that is farther than half of the local radius,
/// with the faces that `beyond` a limit join them, if given for every face.
FarParts uncovered_parts(const FitMesh& surface, const FitReference& reference, const VesselField& field,
                         const std::vector<FarPoint>& beyond = {});

/// The same for parts of the packed surface that are far from the reference.
FarParts unsupported_parts(const FitMesh& surface, const FitReference& reference, const VesselField& field,
                           const std::vector<FarPoint>& beyond = {});

/// Both in a report, with `max_error` as in FitOptions.
void find_far(FitReport& report, const FitMesh& surface, const FitReference& reference, const VesselField& field,
              double max_error);

}  // namespace vmesh::fitting
