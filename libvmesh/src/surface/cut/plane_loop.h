// Where a plane cuts a surface around a point.
#pragma once

#include <optional>
#include <vector>

#include "vmesh/edit/face_table.h"

namespace vmesh {

struct CutPlane {
  Vec3 point, normal;  ///< of unit length

  double distance(const Vec3& p) const { return (p - point).dot(normal); }
};

/// A closed run of faces that the plane cuts, and the edges between them, edges[i] from behind the plane in faces[i].
struct PlaneLoop {
  std::vector<Index> faces;
  std::vector<MeshEdge> edges;
};

/// The innermost loop around the plane's point; nothing if there is none. `distance`: of every vertex from the plane.
std::optional<PlaneLoop> loop_around(const std::vector<Vec3>& positions, const FaceTable& table, const CutPlane& plane,
                                     const std::vector<double>& distance);

/// Where the plane cuts an edge.
inline double share_at_plane(double from, double to) { return from / (from - to); }

}  // namespace vmesh
