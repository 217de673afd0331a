#pragma once

#include <string>
#include <vector>

#include "vmesh/fit/fit_surface.h"

namespace vmesh {

/// Numbers of patches for the faces of a surface whose ends are closed by flat caps.
struct CappedPatches {
  std::vector<Index> patch;  ///< of every face
  /// Those that are caps, ascending. Every cap is one disc over the end of a vessel.
  std::vector<Index> caps;
};

struct CappedFit {
  FitResult fit;
  std::vector<Index> patch;  ///< of every face of the fitted surface
};

/// fit_surface() for a surface that is closed by flat caps, at least one: the caps are left out, the ends fitted as
/// those of an open surface are, in the planes of the reference's caps if there are any near (end_at_caps()), and
/// closed by flat caps again, with the numbers that they had. Faces of the wall have, where this has several patches,
/// that of most faces of their branch before. Throws InvalidInput as fit_surface() does, and for caps that are not
/// discs, that touch each other, or of which two end the same vessel.
CappedFit fit_capped_surface(const VesselSurface& surface, const CappedPatches& patches, const Centerline& centerline,
                             const TriMesh& reference, const FitOptions& options = {}, const Progress& progress = {});

/// For every face of a surface around `centerline` after a change, the patch that most faces of its branch had before;
/// of branches that had none, the first of `before`'s patches.
std::vector<Index> patches_by_branch(const VesselSurface& before, const std::vector<Index>& patch_before,
                                     const VesselSurface& after, const Centerline& centerline);

}  // namespace vmesh
