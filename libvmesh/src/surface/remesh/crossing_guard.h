#pragma once

#include <array>
#include <functional>
#include <vector>

#include <CGAL/Surface_mesh.h>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

#include "mesh/face_pair.h"

namespace vmesh {

/// Tells for a step of remeshing whether faces would cross each other afterwards. Keeps all faces in box trees; whoever
/// changes the mesh says so (touch). Faces of lids do not count.
class CrossingGuard {
 public:
  using Mesh = CGAL::Surface_mesh<Vec3>;
  using Vertex = Mesh::Vertex_index;
  using Halfedge = Mesh::Halfedge_index;
  using Face = Mesh::Face_index;

  /// `is_lid`: for every vertex, whether it is the middle of a lid; the mesh is kept as a reference.
  CrossingGuard(const Mesh& mesh, std::function<bool(Vertex)> is_lid);

  /// Whether `v` may go to `p`.
  bool may_move(Vertex v, const Vec3& p) const;
  /// Whether the ends of an edge may become one vertex at `p`.
  bool may_collapse(Vertex a, Vertex b, const Vec3& p) const;
  /// Whether the edge of `h` may be exchanged for the other diagonal of its two faces.
  bool may_flip(Halfedge h) const;

  /// The faces around `v` are new or have changed.
  void touch(Vertex v);

 private:
  // Faces as they once were; those that have changed since are in a later one as well.
  struct Layer {
    std::vector<Face> faces;
    BoxTree tree;
  };

  void insert(Face f);
  void add_layer(std::vector<Face> faces);
  bool is_lid(Face f) const;
  PlacedFace placed(Face f) const;
  // Whether no face but `gone` crosses one of `faces`, nor they each other.
  bool clear(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;
  bool is_crossed(const PlacedFace& face, const std::vector<Face>& gone) const;

  const Mesh& mesh_;
  std::function<bool(Vertex)> is_lid_;
  std::vector<Layer> layers_;  // each less than half as large as the one before
  std::vector<Face> latest_;   // not in a layer yet
};

}  // namespace vmesh
