#pragma once

#include <array>
#include <vector>

#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A manifold surface of changing connectivity, in plain arrays. Removed faces and vertices keep their numbers until
/// pack().
class FitMesh {
 public:
  /// A vertex and its attributes.
  struct Vertex {
    Vec3 position = Vec3::Zero();
    Index cone = kNone;     ///< of the vessel field, the nearest one
    Index opening = kNone;  ///< on whose ring the vertex lies
    double size = 0;        ///< intended length of the edges, mm
    double base_size = 0;   ///< size on the surface as given
  };

  FitMesh(const TriMesh& mesh, std::vector<Vertex> vertices);

  std::vector<Vertex> vertices;
  std::vector<Triangle> faces;

  bool has_vertex(Index v) const { return !around_[v].empty(); }
  bool has_face(Index f) const { return faces[f][0] != kNone; }
  std::size_t vertex_count() const { return vertex_count_; }

  const Vec3& position(Index v) const { return vertices[v].position; }
  std::array<Vec3, 3> corners(Index f) const {
    return {position(faces[f][0]), position(faces[f][1]), position(faces[f][2])};
  }
  /// Normal whose length is twice the area.
  Vec3 area_normal(Index f) const;
  Vec3 unit_normal(Index f) const;
  Vec3 vertex_normal(Index v) const;  ///< unit, area-weighted

  const std::vector<Index>& faces_around(Index v) const { return around_[v]; }
  /// Ascending.
  void neighbours(Index v, std::vector<Index>& result) const;
  bool are_neighbours(Index a, Index b) const;
  /// The face in which the edge from a to b runs in this direction; kNone at a border.
  Index face_of(Index a, Index b) const;
  static Index apex(const Triangle& face, Index a, Index b);
  bool on_border(Index v) const { return vertices[v].opening != kNone; }
  double mean_edge(Index v) const;

  /// All edges as (a, b) with a < b, in the order of the faces.
  std::vector<std::array<Index, 2>> edges() const;

  /// Flips the edge from a to b. Both faces must exist.
  void flip(Index a, Index b);
  /// Puts a vertex on an edge of two faces; returns its number.
  Index split(Index a, Index b, const Vertex& middle);
  /// Merges b into a. Requires may_collapse().
  void collapse(Index a, Index b);
  /// Whether collapsing keeps the surface manifold, with the same topology.
  bool may_collapse(Index a, Index b) const;

  /// Removes unused numbers; returns the new numbers of the vertices.
  std::vector<Index> pack();
  /// The mesh; must be packed.
  TriMesh tri_mesh() const;

 private:
  void detach(Index f);
  void attach(Index f);

  std::vector<std::vector<Index>> around_;  // faces, ascending
  std::size_t vertex_count_ = 0;
};

/// Whether a vertex must stay as it is: one flag each; vertices newer than the flags are not frozen.
inline bool is_frozen(const std::vector<char>& frozen, Index v) { return v < frozen.size() && frozen[v]; }

}  // namespace vmesh
