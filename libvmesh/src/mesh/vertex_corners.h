#pragma once

#include <span>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// The corners of faces at every vertex: corner 3 f + i is the i-th of face f. Takes 28 bytes a vertex.
class VertexCorners {
 public:
  explicit VertexCorners(const TriMesh& mesh);

  /// Ascending.
  std::span<const Index> at(Index vertex) const {
    return {corners_.data() + first_[vertex], corners_.data() + first_[vertex + 1]};
  }

 private:
  std::vector<Index> first_, corners_;
};

/// One side of a face as seen from a vertex at its end.
struct SideAt {
  Index other;    ///< the vertex at the other end
  Index corner;   ///< which of the vertex's corners it is a side of
  bool outwards;  ///< the face runs from the vertex to the other one
};

/// Fills in the sides at a vertex, those of an edge adjacent: by the other vertex, then by the face. A side that begins
/// and ends at the vertex is listed once, as outwards.
void list_sides(const TriMesh& mesh, const VertexCorners& corners, Index vertex, std::vector<SideAt>& sides);

}  // namespace vmesh
