#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/volume/vessel_field.h"

namespace vmesh {

/// A closed surface around what a volume holds of a body-centred cubic lattice.
struct LatticeSurface {
  std::vector<Vec3> vertices;
  std::vector<Index> cones;  ///< hint for a query at every vertex
  std::vector<Triangle> faces;
  std::size_t handles = 0;  ///< genus of the surface
};

/// Grows a set of lattice points from `seed`, a point within the volume, deepest first, by points whose addition
/// changes neither the topology of the set nor that of its complement ("simple points"); then takes the surface between
/// the set and the rest of the lattice, tetrahedron by tetrahedron (marching tetrahedra). The surface is closed,
/// 2-manifold and without self-intersections whatever the volume looks like. Its genus is 0, except that up to
/// `max_handles` times two fronts that meet within the volume are joined.
///
/// `spacing` is the edge of the lattice's cubes, `frame` its directions. Queries are local, from `hint` on.
/// Throws InvalidInput when more than `max_points` points would be needed.
LatticeSurface grow_in_lattice(const VesselField& field, const Vec3& seed, Index hint, double spacing,
                               const Eigen::Matrix3d& frame, std::size_t max_handles);

}  // namespace vmesh
