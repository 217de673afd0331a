#pragma once

#include <vector>

#include "vmesh/io/surface_io.h"
#include "vmesh/surface/generate.h"

namespace vmesh::tool {

/// The places on the centerline that a surface's file has. Throws InvalidInput if it has none or they are not of this
/// centerline.
std::vector<CenterlineBinding> binding_of(const LoadedSurface& surface, const Centerline& centerline);

}  // namespace vmesh::tool
