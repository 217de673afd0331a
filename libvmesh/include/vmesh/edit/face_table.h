#pragma once

#include <array>
#include <utility>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// An edge of a surface, by its ends.
struct MeshEdge {
  Index a, b;
  auto operator<=>(const MeshEdge&) const = default;
};

inline bool has_corner(const Triangle& face, Index v) { return face[0] == v || face[1] == v || face[2] == v; }

/// The connectivity of an oriented surface that changes, in plain arrays: faces by their corners, vertices by their
/// faces. Removed faces keep their numbers until they are packed. Borders are allowed, and vertices at which several
/// sheets meet.
class FaceTable {
 public:
  FaceTable() = default;
  FaceTable(std::vector<Triangle> faces, std::size_t vertices);

  /// With removed ones, see has_face().
  const std::vector<Triangle>& faces() const { return faces_; }
  bool has_face(Index f) const { return faces_[f][0] != kNone; }
  /// Whether the vertex has a face.
  bool has_vertex(Index v) const { return !around_[v].empty(); }
  /// Those that have a face.
  std::size_t vertex_count() const;

  /// Ascending.
  const std::vector<Index>& faces_around(Index v) const { return around_[v]; }
  /// Ascending.
  void neighbours(Index v, std::vector<Index>& result) const;
  bool are_neighbours(Index a, Index b) const;
  /// The face in which the edge from a to b runs in this direction; kNone at a border.
  Index face_of(Index a, Index b) const;
  /// The corner of a face that is not an end of its edge; kNone if there is none.
  static Index apex(const Triangle& face, const MeshEdge& e);
  /// The corners opposite an inner edge, to its left and to its right.
  std::array<Index, 2> opposite(const MeshEdge& e) const;
  /// Whether the edge exists and has a face on either side.
  bool is_inner(const MeshEdge& e) const { return face_of(e.a, e.b) != kNone && face_of(e.b, e.a) != kNone; }
  /// Whether there are faces all around the vertex.
  bool is_inner(Index v) const;

  /// All edges as (a, b) with a < b, in the order of the faces.
  std::vector<MeshEdge> edges() const;

  /// Whether an inner edge's opposite corners are not neighbours yet.
  bool may_flip(const MeshEdge& e) const;
  /// Whether collapsing an edge between inner vertices keeps the surface manifold, with the same topology.
  bool may_collapse(const MeshEdge& e) const;

  void set_face(Index f, const Triangle& face);
  void remove_face(Index f) { set_face(f, kRemoved); }
  Index add_face(const Triangle& face);

 protected:
  static constexpr Triangle kRemoved = {kNone, kNone, kNone};

  void add_vertex() { around_.emplace_back(); }

  /// Removes unused numbers; returns the new numbers of the vertices.
  std::vector<Index> pack_faces();

  // What set_face() has overwritten since the first open transaction began.
  struct FaceMark {
    std::size_t written, faces, vertices;
  };
  FaceMark open();
  void close() { --open_; }
  void undo(const FaceMark& mark);
  bool is_open() const { return open_ > 0; }
  std::vector<Index> faces_since(const FaceMark& mark) const;

 private:
  void attach(Index f);
  void detach(Index f);

  std::vector<Triangle> faces_;
  std::vector<std::vector<Index>> around_;
  std::vector<std::pair<Index, Triangle>> written_;
  int open_ = 0;  // transactions
};

}  // namespace vmesh
