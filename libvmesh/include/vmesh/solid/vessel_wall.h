#pragma once

#include <string>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A closed surface around vessels, divided into patches: the wall, and flat caps over ends of vessels.
struct VesselWall {
  TriMesh mesh;
  std::vector<double> radius;            ///< of the vessel at every vertex, mm
  std::vector<Index> patch;              ///< of every face, in patch_names
  std::vector<std::string> patch_names;  ///< "wall", then "cap_1" ...
  Index wall_patches = 1;                ///< the first of the patches, which are parts of the wall; all others are caps

  bool is_wall(std::size_t face) const { return patch[face] < wall_patches; }
};

/// A surface with the attributes of `vmesh generate`: "radius" of vertices, and "ModelFaceID" of faces, without which
/// all faces are of the wall. Which patches are is_wall_patch(): 1, or all whose names begin with "wall". Patches have
/// the names that the attributes give them; else the cap with number k + 1 is called cap_k. Throws InvalidInput without
/// radii, for radii that are not positive and for numbers of faces that are not positive integers.
VesselWall vessel_wall(TriMesh mesh, const MeshAttributes& attributes);

}  // namespace vmesh
