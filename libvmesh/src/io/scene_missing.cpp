// Replaces scene_reader.cpp in a build without assimp.
#include "vmesh/core/error.h"

#include "formats.h"

namespace vmesh::io {

LoadedSurface read_scene(const std::filesystem::path& path) {
  throw Unsupported(path.string() +
                    ": reading GLB, glTF, 3MF, COLLADA, X3D and FBX needs assimp and this vmesh was built without it "
                    "(CMake option VMESH_WITH_ASSIMP); convert the surface to .ply, .obj, .off or .stl");
}

}  // namespace vmesh::io
