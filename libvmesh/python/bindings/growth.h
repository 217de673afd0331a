#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/production/produce.h"

#include "objects.h"

namespace vmesh::python {

/// The surface that produce() makes, with warnings in the words of the command. A budget chooses the resolution.
SurfacePtr grow(const CenterlinePtr& centerline, ProductionOptions options, const std::optional<Budget>& budget,
                const Progress& progress);

/// A copy whose openings are finished. Throws InvalidInput for a surface that is not bound to a centerline.
SurfacePtr with_finished_ends(const SurfaceObject& surface, const FlatEndOptions& options);

}  // namespace vmesh::python
