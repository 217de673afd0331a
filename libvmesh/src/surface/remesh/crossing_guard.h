#pragma once

#include <array>
#include <functional>
#include <vector>

#include <CGAL/Surface_mesh.h>

#include "vmesh/core/box_tree.h"
#include "vmesh/core/types.h"
#include "vmesh/mesh/face_pair.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// Tells whether a remeshing step would make faces cross each other, or cross an axis line that they did not cross
/// before. Keeps all faces in box trees; changes to the mesh must be announced (touch). Faces of lids do not count.
class CrossingGuard {
 public:
  using Mesh = CGAL::Surface_mesh<Vec3>;
  using Vertex = Mesh::Vertex_index;
  using Halfedge = Mesh::Halfedge_index;
  using Face = Mesh::Face_index;

  using AxisLine = std::array<Vec3, 2>;

  /// `is_lid`: whether a vertex is the centre of a lid. `axes`: the axis lines, which belong inside. Keeps a reference
  /// to the mesh.
  CrossingGuard(const Mesh& mesh, std::function<bool(Vertex)> is_lid, std::vector<AxisLine> axes);

  /// Whether `v` may go to `p`.
  bool may_move(Vertex v, const Vec3& p) const;
  /// Whether the ends of an edge may become one vertex at `p`.
  bool may_collapse(Vertex a, Vertex b, const Vec3& p) const;
  /// Whether the edge of `h` may be flipped.
  bool may_flip(Halfedge h) const;

  /// The faces around `v` are new or have changed.
  void touch(Vertex v);

 private:
  // A face keeps its box until it leaves it; then it gets a new one.
  struct Box {
    Vec3 low = Vec3::Ones(), high = -Vec3::Ones();
    Index number = kNone;  // boxes are numbered in the order in which they were needed
  };
  struct Entry {
    Face face;
    Index number;  // of the box; outdated if it is not the face's current one
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
  // Whether `faces` cross neither each other nor any face outside `gone`.
  bool clear(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;
  bool cross_others(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;
  // Whether one of `faces` meets an axis line that none of `gone` meets.
  bool cross_axes(const std::vector<PlacedFace>& faces, const std::vector<Face>& gone) const;

  const Mesh& mesh_;
  std::function<bool(Vertex)> is_lid_;
  std::vector<Box> box_;  // of every face
  Index next_number_ = 0;
  std::vector<Layer> layers_;  // each less than half as large as the one before
  std::vector<Entry> latest_;  // not yet in a layer
  std::vector<AxisLine> axes_;
  BoxTree axis_tree_;  // of the parts of axis lines
};

}  // namespace vmesh
