#pragma once

#include <vector>

#include "vmesh/centerline/edits.h"
#include "vmesh/mesh/volume_mesh.h"

namespace vmesh {

/// Where the points of a mesh around `centerline` go when that is edited: as follow_edit_within() says, and points
/// inside move on from tetrahedra that became flat, with an angle of less than 8 degrees between faces. If cells would
/// turn over, points of layers stay over their point of the wall instead, at the same share of the radius, and points
/// inside move on, until no cell is turned over; where that does not do, layers lean to where they see the wall best,
/// and become thinner. The outside of a shell goes with the wall, thinner where it would cross itself; the wall and the
/// caps go where follow_edit_within() says. Where nothing helps, all points do. Connectivity stays; whether the mesh is
/// sound is for the caller to check (find_volume_defects()). Throws InvalidInput as follow_edit_within() does, and for
/// a mesh that check_volume_mesh() refuses.
std::vector<Vec3> follow_edit(const VolumeMesh& mesh, const Centerline& centerline, const CenterlineEdit& edit);

}  // namespace vmesh
