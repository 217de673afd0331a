#pragma once

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::bench {

/// CGAL's Mesh_3 on the volume of a centerline's vessels. Facets as long as an edge of a polygon with so many corners
/// around the vessel there, as far off as the sagitta of the thinnest, 30 degrees at least.
TriMesh mesh_3(const Centerline& centerline, double around, double blend = 0);

}  // namespace vmesh::bench
