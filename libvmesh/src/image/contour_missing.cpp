// Replaces contour.cpp in a build without VTK.
#include "vmesh/core/error.h"
#include "vmesh/image/contour.h"

namespace vmesh {

TriMesh contour(const VoxelImage&, double) {
  throw Unsupported(
      "marching cubes needs VTK and this vmesh was built without it (CMake option VMESH_WITH_VTK); give a surface "
      "instead of an image");
}

}  // namespace vmesh
