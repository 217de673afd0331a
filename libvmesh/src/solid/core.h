#pragma once

#include <string>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// A point of layers, over a vertex of the wall.
struct LayerPoint {
  Index vertex = 0, level = 0;
  Vec3 position = Vec3::Zero();
};

/// A closed surface to be filled with tetrahedra, and how long their edges are to be at every vertex (mm).
struct CoreSurface {
  TriMesh mesh;            ///< the last faces are those of caps
  std::vector<Index> cap;  ///< patches of those
  std::vector<double> size;
  std::vector<LayerPoint> beside;      ///< corners of cells of the core outside of `mesh`, see take_layer_ends()
  std::vector<Triangle> faces_beside;  ///< of these cells, at the outside of the core
};

/// Tetrahedra within a closed surface, whose faces are theirs.
struct Core {
  std::vector<Vec3> added;              ///< points inside
  std::vector<Tetrahedron> tetrahedra;  ///< corners: vertices of the surface, those beside it, then added points
  std::string failure;                  ///< why there are none; else empty
};

/// By TetGen. Faces and vertices of the surface are kept. Throws Unsupported in a build without it.
Core fill_core(const CoreSurface& surface);

/// Tetrahedra between closed surfaces and a box around them, not refined. `within`: points in what the surfaces
/// enclose, which is left empty. Throws Unsupported as above.
Core fill_around(const TriMesh& surfaces, const std::vector<Vec3>& within);

}  // namespace vmesh
