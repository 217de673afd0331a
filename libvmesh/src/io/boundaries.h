// The boundaries of a flow domain, by names, for formats that have room for these. Internal to the module.
#pragma once

#include <string>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::io {

struct Boundary {
  std::string name;
  std::vector<Index> faces;
};

/// By the names of patches, if there are any and ModelFaceID assigns faces to them; by the attribute CapID of faces:
/// "wall", then "cap_1" and so on; else by ModelFaceID: "face_1" and so on, as the walls of other programs are numbered
/// in any way; without either all faces, as "surface".
std::vector<Boundary> boundaries_of(const TriMesh& mesh, const MeshAttributes& attributes);

}  // namespace vmesh::io
