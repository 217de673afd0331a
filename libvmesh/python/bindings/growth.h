#pragma once

#include "vmesh/core/progress.h"
#include "vmesh/production/produce.h"

#include "objects.h"

namespace vmesh::python {

/// The surface that produce() makes, with warnings in the words of the command.
SurfacePtr grow(const CenterlinePtr& centerline, const ProductionOptions& options, const Progress& progress);

/// A copy whose openings are finished. Throws InvalidInput for a surface that is not bound to a centerline.
SurfacePtr with_finished_ends(const SurfaceObject& surface, const FlatEndOptions& options);

}  // namespace vmesh::python
