#include "vmesh/mesh/check_indices.h"

#include <string>

#include "vmesh/core/error.h"

namespace vmesh {

void check_indices(const TriMesh& mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index v : mesh.faces[f]) {
      if (v >= mesh.vertices.size()) {
        throw InvalidInput("face " + std::to_string(f) + " names vertex " + std::to_string(v) + ", but the mesh has " +
                           std::to_string(mesh.vertices.size()) + " vertices");
      }
    }
  }
}

}  // namespace vmesh
