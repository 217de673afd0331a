#pragma once

#include "vmesh/core/progress.h"

#include "objects.h"

namespace vmesh::python {

enum class EndShape { round, flat, open };

/// Throws InvalidInput unless it is "round", "flat" or "open".
EndShape parse_end_shape(const std::string& text);

/// Options for growing a surface.
struct GrowthRequest {
  GenerateOptions options;  ///< open_ends: nodes that are left open regardless of `ends`
  bool separate = true;     ///< narrow vessels that touch, or move them apart
  double gap = 0.1;         ///< to be left between them, in smaller radii
  EndShape ends = EndShape::round;
  double extension = 0;  ///< of ends that are not round, in radii
};

/// The surface around a centerline as the command makes it: simplified, separated, grown (once more with all nodes if
/// that is not sound), ends finished. Its numbers are those of the centerline. Throws like generate_surface() and
/// separate_contacts().
SurfacePtr grow(const CenterlinePtr& centerline, const GrowthRequest& request, const Progress& progress);

/// A copy whose openings are finished. Throws InvalidInput for a surface that is not bound to a centerline.
SurfacePtr with_finished_ends(const SurfaceObject& surface, const FlatEndOptions& options);

}  // namespace vmesh::python
