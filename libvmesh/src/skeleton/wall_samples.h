// Points on a surface, spread by area, internal to the module.
#pragma once

#include <functional>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh::skeleton {

/// Points on faces, each representing a piece of its face.
struct WallSamples {
  std::vector<Vec3> points;   ///< centroids of the pieces, mm
  std::vector<Vec3> normals;  ///< unit, of their faces
  std::vector<double> areas;  ///< of the pieces, mm^2; those of a face sum to its area
  std::vector<Index> faces;
};

/// Samples in the order of faces. `spacing`: called once per face, the greatest distance between its samples in mm,
/// along and across it, so a long triangle has many of them; 0 or less: the face has none. A face with no edge longer
/// than the spacing has one; faces without area have none. Throws InvalidInput when a face names a vertex that does not
/// exist, Unsupported if there is not enough free memory.
WallSamples samples_by_area(const TriMesh& mesh, const std::function<double(Index face)>& spacing);

/// Moves the samples off their faces onto the smooth wall that the vertices lie on: vertices of measured surfaces are
/// on the wall, and the faces between them are chords within it (an octagon's are 5 % nearer to its middle). Phong
/// tessellation (Boubekeur and Alexa 2008) with half of the projection, which is right for circles up to the fourth
/// power of the angle. Normals are those of faces that are wall; faces at more than 60 degrees to one of a vertex stay
/// as they are there.
void move_onto_smooth_wall(WallSamples& samples, const TriMesh& mesh, const std::function<bool(Index face)>& is_wall);

}  // namespace vmesh::skeleton
