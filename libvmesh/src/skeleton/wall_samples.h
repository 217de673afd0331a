// Points on a surface, spread by area, internal to the module.
#pragma once

#include <functional>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// Points on faces, each representing a piece of its face.
struct WallSamples {
  std::vector<Vec3> points;   ///< centroids of the pieces, mm
  std::vector<Vec3> normals;  ///< unit, of their faces
  std::vector<double> areas;  ///< of the pieces, mm^2; those of a face sum to its area
  std::vector<Index> faces;
};

/// Samples in the order of faces. `spacing`: called once per face, the greatest distance between its samples in mm,
/// along and across it, so a long triangle has many of them; 0 or less: the face has none. A face with no edge longer
/// than the spacing has one; faces without area have none. Throws InvalidInput when a face names a vertex that does not
/// exist, Unsupported if there is not enough free memory.
WallSamples samples_by_area(const TriMesh& mesh, const std::function<double(Index face)>& spacing);

}  // namespace vmesh::skeleton
