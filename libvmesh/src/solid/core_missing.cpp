#include "vmesh/core/error.h"
#include "vmesh/solid/make_volume.h"

#include "solid/core.h"

namespace vmesh {

bool can_mesh_lumen() { return false; }

Core fill_core(const CoreSurface&) {
  throw Unsupported(
      "this build has no TetGen, which fills lumens with tetrahedra (libtet1.5-dev); a shell alone needs none");
}

Core fill_around(const TriMesh&, const std::vector<Vec3>&) {
  throw Unsupported("this build has no TetGen (libtet1.5-dev), which fills what is between walls that are merged");
}

}  // namespace vmesh
