#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/deform/surface_binding.h"
#include "vmesh/io/surface_io.h"
#include "vmesh/mesh/find_attribute.h"
#include "vmesh/surface/generate.h"

#include "command_line/console.h"

namespace vmesh::tool {

/// A vertex farther from its place than this many local radii must be bound to another centerline.
inline constexpr double kFarthestPlace = 4;

/// A surface bound to a centerline, at rest.
struct BoundTree {
  Centerline centerline;
  TriMesh mesh;
  MeshAttributes attributes;
  std::vector<CenterlineBinding> binding;
};

/// By the places in the surface's file if they belong to this centerline; else every vertex is bound to the nearest
/// segment, and the console is told.
BoundTree bound_tree(const Centerline& centerline, LoadedSurface surface, Console& console);

std::vector<SurfacePlace> places_on(const std::vector<CenterlineBinding>& binding);

}  // namespace vmesh::tool
