#pragma once

#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/surface/flat_ends.h"
#include "vmesh/surface/generate.h"

namespace vmesh {

/// What a surface around a centerline is written with. By vertex: radius, segment and parameter of the binding, branch,
/// and where the surface is open, opening (from 1; 0: at none). By face: skewness and branch.
MeshAttributes surface_attributes(const TriMesh& mesh, const std::vector<CenterlineBinding>& binding,
                                  const std::vector<double>& radius, const std::vector<Opening>& openings,
                                  const Centerline& centerline);

/// Adds labels of faces as SimVascular has them: ModelFaceID, 1 for the wall and from 2 on for caps, and CapID, -1 for
/// the wall.
void add_cap_labels(const FlatEnds& ends, MeshAttributes& attributes);

}  // namespace vmesh
