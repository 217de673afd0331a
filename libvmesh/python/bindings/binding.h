#pragma once

#include "vmesh/deform/surface_binding.h"

#include "objects.h"

namespace vmesh::python {

/// Binds a surface that was not grown here: every vertex to the place given by the surface's attributes if all fit this
/// centerline, else to the nearest.
void bind_to(SurfaceObject& surface, const CenterlinePtr& centerline);

/// The binding in the form needed for deformation.
std::vector<SurfacePlace> places_of(const SurfaceObject& surface);

}  // namespace vmesh::python
