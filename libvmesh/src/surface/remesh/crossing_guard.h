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

/// Tells for a step of remeshing whether faces would cross each other afterwards, or a axis that they did not cross
/// before. Keeps all faces in box trees; whoever changes the mesh says so (touch). Faces of lids do not count.
class CrossingGuard {
 public:
  using Mesh = CGAL::Surface_mesh<Vec3>;
  using Vertex = Mesh::Vertex_index;
  using Halfedge = Mesh::Halfedge_index;
  using Face = Mesh::Face_index;

  using AxisLine = std::array<Vec3, 2>;

  /// `is_lid`: for every vertex, whether it is the middle of a lid; the mesh is kept as a reference. `axes`:
  /// straight pieces of the axes of the vessels, which belong inside.
  CrossingGuard(const Mesh& mesh, std::function<bool(Vertex)> is_lid, std::vector<AxisLine> axes);

  /// Whether `v` may go to `p`.
  bool may_move(Vertex v, const Vec3& p) const;
  /// Whether the ends of an edge may become one vertex at `p`.
  bool may_collapse(Vertex a, Vertex b, const Vec3& p) const;
  /// Whether the edge of `h` may be exchanged for the other diagonal of its two faces.
  bool may_flip(Halfedge h) const;

  /// The faces around `v` are new or have changed.
  void touch(Vertex v);

 private:
  // A face lies in its box until it leaves it; then it gets another.
  struct Box {
    Vec3 low = Vec3::Ones(), high = -Vec3::Ones();
    Index number = kNone;  // boxes are numbered in the order in which they were needed
  };
  struct Entry {
    Face face;
    Index number;  // of the box; an older one than the face's own says nothing
  };
  struct Layer {
    std::vector<Entry> entries;
    BoxTree tree;
  };

  void insert(Face f);
  void add_layer(std::vector<Entry> entries);
  bool is_current(const Entry& entry) const;
  bool is_lid(Face f) const;
  PlacedFace placed(Face f) const;
  // Whether no face but `gone` crosses one of `faces`, nor they each other.
  bool clear(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;
  bool cross_others(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;
  // Whether one of `faces` meets a axis that none of `gone` meets.
  bool cross_axes(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;

  const Mesh& mesh_;
  std::function<bool(Vertex)> is_lid_;
  std::vector<Box> box_;  // of every face
  Index next_number_ = 0;
  std::vector<Layer> layers_;  // each less than half as large as the one before
  std::vector<Entry> latest_;  // not in a layer yet
  std::vector<AxisLine> axes_;
  BoxTree axis_tree_;  // of their parts
};

}  // namespace vmesh
