#pragma once

#include "vmesh/core/progress.h"

#include "objects.h"

namespace vmesh::python {

enum class EndShape { round, flat, open };

/// Throws InvalidInput unless it is "round", "flat" or "open".
EndShape parse_end_shape(const std::string& text);

/// What is wanted of a surface.
struct GrowthRequest {
  GenerateOptions options;  ///< open_ends: nodes that are left open whatever `ends` says
  bool separate = true;     ///< vessels that touch are narrowed or moved apart
  double gap = 0.1;         ///< that is then left between them, in smaller radii
  EndShape ends = EndShape::round;
  double extension = 0;  ///< of ends that are not round, in radii
};

/// The surface around a centerline, as the command makes it: simplified, separated, grown; where that is not sound,
/// once more with all nodes; ends finished. Its numbers are those of the centerline. Throws what generate_surface() and
/// separate_contacts() throw.
SurfacePtr grow(const CenterlinePtr& centerline, const GrowthRequest& request, const Progress& progress);

/// A copy whose openings are finished. Throws InvalidInput for a surface that is bound to no centerline.
SurfacePtr with_finished_ends(const SurfaceObject& surface, const FlatEndOptions& options);

}  // namespace vmesh::python
