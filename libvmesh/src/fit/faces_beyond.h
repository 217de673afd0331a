#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::fitting {

/// The point of a face that is farthest from another mesh, of those looked at.
struct FarPoint {
  Vec3 position = Vec3::Zero();
  double distance = -1;  ///< mm; negative: the face is within the limit
};

/// For every face of a mesh, whether it has a point farther from `to` than `limit`, mm. Of the others no point is
/// farther: proven by hausdorff_exceeds(), with a thousandth of the limit as its tolerance.
std::vector<FarPoint> faces_beyond(const TriMesh& from, const TriMesh& to, double limit);

}  // namespace vmesh::fitting
