// Replaces vtp_writer.cpp in a build without VTK.
#include "vmesh/core/error.h"

#include "formats.h"

namespace vmesh::io {
namespace {

[[noreturn]] void fail() {
  throw Unsupported(
      "writing VTP files needs VTK and this vmesh was built without it (CMake option VMESH_WITH_VTK); write .json, "
      ".swc "
      "or .csv for centerlines, .ply, .obj, .off or .stl for surfaces");
}

}  // namespace

void write_centerline_vtp(std::ostream&, const Centerline&, const CenterlineMetadata&, const std::vector<EndSection>&) {
  fail();
}
void write_surface_vtp(std::ostream&, const TriMesh&, const MeshAttributes&, const SurfaceMetadata&) { fail(); }

}  // namespace vmesh::io
