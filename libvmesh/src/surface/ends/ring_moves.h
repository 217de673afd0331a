#pragma once

#include <vector>

#include "vmesh/surface/generate.h"

namespace vmesh {

struct VertexMove {
  Index vertex = kNone;
  Vec3 way = Vec3::Zero();
};

/// The vertices that share an edge with every vertex of a mesh; some twice.
std::vector<std::vector<Index>> neighbours(const TriMesh& mesh);

/// Positions of the vertices of an opening's ring.
std::vector<Vec3> ring_positions(const TriMesh& mesh, const Opening& opening);

/// For every vertex of the mesh, whether it is on the ring of an opening.
std::vector<char> vertices_on_rings(const GenerateResult& result);

/// Moves of a ring by `ways` (one per vertex), and of the vertices behind it, progressively smaller, so that no
/// triangle is stretched by more than a quarter of `edge`, the ring's mean edge. Other rings stay where they are.
std::vector<VertexMove> spread_moves(const std::vector<std::vector<Index>>& neighbours,
                                     const std::vector<char>& is_on_ring, const std::vector<Index>& ring,
                                     const std::vector<Vec3>& ways, double edge);

void apply_moves(const std::vector<VertexMove>& moves, TriMesh& mesh);

}  // namespace vmesh
