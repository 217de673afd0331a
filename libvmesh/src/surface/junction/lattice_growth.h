#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/junction/graded_lattice.h"

namespace vmesh {

/// A closed surface around the lattice points inside a volume.
struct LatticeSurface {
  std::vector<Vec3> vertices;
  std::vector<Index> cones;   ///< hint for a query at every vertex
  std::vector<Index> points;  ///< for every vertex, the lattice point inside that it was cut next to
  std::vector<Triangle> faces;
  std::size_t handles = 0;  ///< genus of the surface
};

/// Grows a set of lattice points from point 0, which lies within the volume, deepest first, by points whose addition
/// changes neither the topology of the set nor that of its complement ("simple points": their links, triangulated
/// spheres, consist of one disc inside and one outside); then extracts the surface between the set and the rest of the
/// lattice by marching tetrahedra. The surface is closed, 2-manifold and without self-intersections whatever the volume
/// looks like. Its genus is 0 plus the number of times two fronts that meet within the volume were joined, at most
/// `max_handles`.
///
/// Queries are local, starting from `hint`.
LatticeSurface grow_in_lattice(const VesselField& field, const GradedLattice& lattice, Index hint,
                               std::size_t max_handles);

}  // namespace vmesh
