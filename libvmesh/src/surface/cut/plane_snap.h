// Vertices near a plane that is to cut a surface, moved into it.
#pragma once

#include <vector>

#include "surface/cut/plane_loop.h"

namespace vmesh {

/// A surface that is being cut: positions, and distances from the plane, exactly 0 for vertices in it.
struct SurfaceAtPlane {
  const FaceTable& table;
  CutPlane plane;
  std::vector<Vec3> positions;
  std::vector<double> distance;
};

/// Moves vertices of cut edges that are so near to the plane that slivers would arise into it, along the surface: the
/// volume stays what it was. Not where triangles would become bad or a face flat in the plane, or the surface only
/// touch it. Returns them.
std::vector<Index> snap_to_plane(SurfaceAtPlane& surface, const PlaneLoop& loop);

}  // namespace vmesh
