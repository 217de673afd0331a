#pragma once

#include <memory>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::bench {

/// A mesh in CGAL's form, so that conversion is not measured.
class CgalMesh {
 public:
  /// Faces that would make the surface non-manifold are repaired or left out.
  explicit CgalMesh(const TriMesh& mesh);
  ~CgalMesh();

  /// The mesh with edges collapsed (Lindstrom and Turk) until this share of them is left.
  TriMesh decimated(double share) const;
  /// The same in the order of quadric errors (Garland and Heckbert).
  TriMesh quadric_decimated(double share) const;
  TriMesh mesh() const;
  double bounded_error_hausdorff(const CgalMesh& to, double tolerance) const;

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

/// Whether the functions below are built in.
bool have_vtk();
/// Largest distance of the vertices of one mesh from another (vtkImplicitPolyDataDistance): not a bound of the
/// distance.
double vtk_vertex_distance(const TriMesh& from, const TriMesh& to);
/// The mesh with edges collapsed in the order of quadric errors (vtkQuadricDecimation) until this share of its faces is
/// left.
TriMesh vtk_quadric_decimated(const TriMesh& mesh, double share);
/// The level set 0 of a distance on a grid (vtkFlyingEdges3D), `value` called for every grid point.
TriMesh vtk_isosurface(const Vec3& low, const Vec3& high, double spacing, double (*value)(const Vec3&, const void*),
                       const void* context);

}  // namespace vmesh::bench
