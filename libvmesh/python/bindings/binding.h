#pragma once

#include "vmesh/deform/surface_binding.h"

#include "objects.h"

namespace vmesh::python {

/// Binds a surface that was not grown here: every vertex to the place that the surface's attributes name, if all are of
/// this centerline, else to the nearest.
void bind_to(SurfaceObject& surface, const CenterlinePtr& centerline);

/// The binding as what deforms takes it.
std::vector<SurfacePlace> places_of(const SurfaceObject& surface);

}  // namespace vmesh::python
