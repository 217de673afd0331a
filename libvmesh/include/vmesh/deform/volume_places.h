#pragma once

#include <span>
#include <vector>

#include "vmesh/deform/surface_binding.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Where the points of a volume mesh belong on a centerline.
struct VolumePlaces {
  std::vector<SurfacePlace> places;  ///< one per point
  std::size_t shared = 0;            ///< points that are vertices of the surface
};

/// Places with which a volume mesh follows as the surface around it does, by a SurfaceBinding of its points. A point
/// that is a vertex of the surface, to a millionth of the largest coordinate, has the vertex's place. Points joined to
/// one whose place is known by edges of wedges between their triangles, as those of layers are, have that place too,
/// so that all of a layer's stack turns alike; without such a point, the place nearest to the point of the stack on the
/// outside. All others have the nearest place. `vertices`, `places`: of the surface. Throws InvalidInput for spans of
/// different length, for cells with points that do not exist, and if no point is one of the surface's and one is
/// farther from the centerline (or from its vessels prolonged beyond their ends) than `farthest` local radii, which it
/// names.
VolumePlaces volume_places(const Centerline& centerline, const VolumeMesh& mesh, std::span<const Vec3> vertices,
                           std::span<const SurfacePlace> places, double farthest);

}  // namespace vmesh
