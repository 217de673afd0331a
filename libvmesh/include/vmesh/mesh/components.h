#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The components of `mesh`, that is of faces joined by common vertices, in the order of their first faces; the order
/// of vertices and faces is kept, vertices without a face are left out. Throws InvalidInput when a face names a vertex
/// that does not exist.
std::vector<TriMesh> split_components(const TriMesh& mesh);

/// Concatenates meshes into one.
TriMesh joined(const std::vector<TriMesh>& meshes);

}  // namespace vmesh
