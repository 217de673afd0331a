// A cell of each kind.
#pragma once

#include <array>

#include "vmesh/mesh/volume_faces.h"

namespace vmesh::testing {

/// A prism of volume 1/2, on one of its quads a pyramid of volume 1/6, and on that a tetrahedron of volume 5/96, whose
/// points have these numbers.
inline VolumeMesh mixed_cells(const std::array<Index, 8>& n = {0, 1, 2, 3, 4, 5, 6, 7}) {
  VolumeMesh mesh;
  const std::array<Vec3, 8> places = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),         Vec3(0, 0, 1),
                                      Vec3(1, 0, 1), Vec3(0, 1, 1), Vec3(0.75, 0.75, 0.5), Vec3(1.25, 0.5, 0.5)};
  mesh.points.resize(n.size());
  for (std::size_t i = 0; i < n.size(); ++i) mesh.points[n[i]] = places[i];
  mesh.tetrahedra = {{n[1], n[6], n[4], n[7]}};
  mesh.wedges = {{n[0], n[1], n[2], n[3], n[4], n[5]}};
  mesh.pyramids = {{n[1], n[2], n[5], n[4], n[6]}};
  mesh.cell_region = {0, 1, 0};
  mesh.region_names = {"core", "layers"};
  mesh.patch_names = {"wall", "end"};
  for (const CellFace& face : outer_faces(mesh)) mesh.boundary.push_back({face, face[3] == kNone ? 0u : 1u});
  return mesh;
}

}  // namespace vmesh::testing
