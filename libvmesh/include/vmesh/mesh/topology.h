#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The topology of a triangle mesh, coincident vertices counted as different.
struct Topology {
  bool closed = false;                    ///< every edge has two faces or more
  bool manifold = false;                  ///< no edge with more than two faces, no vertex with two fans
  bool oriented = false;                  ///< neighbouring faces run along their common edge in opposite directions
  bool outward = false;                   ///< closed, oriented, and every component encloses a positive volume
  std::size_t components = 0;             ///< of faces, joined by common vertices
  std::size_t boundary_edges = 0;         ///< edges with one face
  std::size_t boundary_loops = 0;         ///< connected components of the boundary; loops that touch count as one
  std::size_t crowded_edges = 0;          ///< edges with three faces or more
  std::int64_t euler_characteristic = 0;  ///< vertices - edges + faces; vertices without a face do not count
  std::int64_t genus = 0;                 ///< sum over components; defined when closed, manifold and oriented, else 0
};

/// Throws InvalidInput when a face names a vertex that does not exist.
Topology measure_topology(const TriMesh& mesh);

/// Volume enclosed by a closed oriented mesh (mm^3), positive when faces are outward.
double enclosed_volume(const TriMesh& mesh);

/// Pairs of faces that intersect other than in their common vertices or edge, each pair in ascending order, the
/// list sorted. Degenerate faces are not tested. Exact predicates (CGAL).
std::vector<std::pair<Index, Index>> self_intersections(const TriMesh& mesh);

/// Those of them whose faces belong to different groups. Group k ends where group k + 1 begins, at face `first_face[k +
/// 1]`; `first_face` is ascending and begins with 0.
std::vector<std::pair<Index, Index>> intersections_between(const TriMesh& mesh, std::span<const Index> first_face);

/// Faces without area, ascending: with equal, coincident or collinear corners. Exact predicates. Throws InvalidInput
/// when a face names a vertex that does not exist, like duplicate_faces().
std::vector<Index> degenerate_faces(const TriMesh& mesh);

/// Faces with the same three vertices as an earlier face, in whatever order, ascending.
std::vector<Index> duplicate_faces(const TriMesh& mesh);

/// Edges with one face, in the face's direction (from, to); ascending by the lower vertex, then the higher. Throws
/// InvalidInput when a face names a vertex that does not exist.
std::vector<std::array<Index, 2>> boundary_edges(const TriMesh& mesh);

/// Number of edges at every vertex; 0 for a vertex without a face.
std::vector<Index> valences(const TriMesh& mesh);

/// For every point, whether it lies strictly inside the closed mesh (exact predicates). Throws InvalidInput when
/// the mesh is not closed.
std::vector<bool> points_inside(const TriMesh& mesh, const std::vector<Vec3>& points);

}  // namespace vmesh
