#include "vmesh/core/error.h"

#include "peers.h"

namespace vmesh::bench {

bool have_vtk() { return false; }
double vtk_vertex_distance(const TriMesh&, const TriMesh&) { throw Unsupported("built without VTK"); }
TriMesh vtk_quadric_decimated(const TriMesh&, double) { throw Unsupported("built without VTK"); }
TriMesh vtk_isosurface(const Vec3&, const Vec3&, double, double (*)(const Vec3&, const void*), const void*) {
  throw Unsupported("built without VTK");
}

}  // namespace vmesh::bench
