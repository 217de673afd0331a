// Stands in for vtp.cpp in a build without VTK.
#include "vmesh/core/error.h"

#include "formats.h"

namespace vmesh::io {
namespace {

[[noreturn]] void fail(const std::string& source) {
  throw Unsupported(
      source + (source.empty() ? "" : ": ") +
      "VTP files need VTK and this vmesh was built without it (CMake option VMESH_WITH_VTK); use .json, .swc "
      "or .csv for centerlines, .ply, .obj, .off or .stl for surfaces");
}

}  // namespace

RawCenterline parse_centerline_vtp(std::string_view, const std::string& source, const std::string&) { fail(source); }
void write_centerline_vtp(std::ostream&, const Centerline&, const CenterlineMetadata&) { fail(""); }
LoadedSurface parse_surface_vtp(std::string_view, const std::string& source) { fail(source); }
void write_surface_vtp(std::ostream&, const TriMesh&, const MeshAttributes&, const SurfaceMetadata&) { fail(""); }

}  // namespace vmesh::io
