#pragma once

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::bench {

/// CGAL's Mesh_3 on the volume of a centerline's vessels. Facets are as long as the edges of a polygon with `around`
/// corners around the local vessel, within the sagitta of the thinnest, with angles of at least 30 degrees.
TriMesh mesh_3(const Centerline& centerline, double around, double blend = 0);

}  // namespace vmesh::bench
