#pragma once

#include <vector>

#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/volume/vessel_field.h"

#include "surface/junction/graded_lattice.h"

namespace vmesh {

/// A closed surface around what a volume holds of a lattice.
struct LatticeSurface {
  std::vector<Vec3> vertices;
  std::vector<Index> cones;   ///< hint for a query at every vertex
  std::vector<Index> points;  ///< of the lattice, off which every vertex cuts the rest
  std::vector<Triangle> faces;
  std::size_t handles = 0;  ///< genus of the surface
};

/// Grows a set of lattice points from point 0, which lies within the volume, deepest first, by points whose addition
/// changes neither the topology of the set nor that of its complement ("simple points": their links, triangulated
/// spheres, fall into one disc inside and one outside); then takes the surface between the set and the rest of the
/// lattice, tetrahedron by tetrahedron (marching tetrahedra). The surface is closed, 2-manifold and without
/// self-intersections whatever the volume looks like. Its genus is 0, except that up to `max_handles` times two fronts
/// that meet within the volume are joined.
///
/// Queries are local, from `hint` on.
LatticeSurface grow_in_lattice(const VesselField& field, const GradedLattice& lattice, Index hint,
                               std::size_t max_handles);

}  // namespace vmesh
