#pragma once

#include "objects.h"

namespace vmesh::python {

/// Those of the file, or those of surface_attributes() and the caps.
MeshAttributes attributes_of(const SurfaceObject& surface);

}  // namespace vmesh::python
