#pragma once

#include <vector>

#include "vmesh/centerline/edits.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Where the points of a mesh around `centerline` go when that is edited: as follow_edit_within() says. If cells would
/// turn over, points of layers stay over their point of the wall instead, at the same share of the radius, and points
/// inside move on, until no cell is turned over; the wall and the caps go where they went, the outside of a shell with
/// the wall. Where that does not help, follow_edit_within() alone. Connectivity stays; whether the mesh is sound is for
/// the caller to check (find_volume_defects()). Throws InvalidInput as follow_edit_within() does, and for a mesh that
/// check_volume_mesh() refuses.
std::vector<Vec3> follow_edit(const VolumeMesh& mesh, const Centerline& centerline, const CenterlineEdit& edit);

}  // namespace vmesh
