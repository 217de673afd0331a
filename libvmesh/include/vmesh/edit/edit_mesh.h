#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "vmesh/edit/face_table.h"
#include "vmesh/edit/step.h"
#include "vmesh/mesh/face_pair.h"

namespace vmesh {

/// A surface that is changed step by step: FaceTable with vertices. A vertex V has a member `position` (mm) and
/// whatever else belongs to it. Removed vertices keep their numbers until pack().
template <class V>
class EditMesh : public FaceTable {
 public:
  using Vertex = V;
  /// `vertex` is kNone where none is added or moved.
  using Step = vmesh::Step<Index, Index, V>;

  EditMesh() = default;
  EditMesh(std::vector<Triangle> faces, std::vector<V> vertices)
      : FaceTable(std::move(faces), vertices.size()), vertices_(std::move(vertices)) {}

  /// With removed ones, see has_vertex().
  const std::vector<V>& vertices() const { return vertices_; }
  const V& vertex(Index v) const { return vertices_[v]; }
  const Vec3& position(Index v) const { return vertices_[v].position; }
  /// To change the vertex; an open transaction remembers what it was.
  V& edit(Index v) {
    if (is_open()) written_.emplace_back(v, vertices_[v]);
    return vertices_[v];
  }
  Index add_vertex(V vertex) {
    vertices_.push_back(std::move(vertex));
    FaceTable::add_vertex();
    return static_cast<Index>(vertices_.size() - 1);
  }

  std::array<Vec3, 3> corners(Index f) const {
    const auto& [a, b, c] = faces()[f];
    return {position(a), position(b), position(c)};
  }
  PlacedFace placed(Index f) const { return {faces()[f], corners(f)}; }
  /// The face as it will be after the step.
  PlacedFace placed(const Triangle& face, const Step& step) const {
    PlacedFace result{face, {}};
    for (std::size_t k = 0; k < 3; ++k)
      result.points[k] = face[k] == step.vertex ? step.target.position : position(face[k]);
    return result;
  }

  /// Normal whose length is twice the area.
  Vec3 area_normal(Index f) const {
    const auto [a, b, c] = corners(f);
    return (b - a).cross(c - a);
  }
  Vec3 unit_normal(Index f) const { return unit_or_zero(area_normal(f)); }
  /// Unit, area-weighted.
  Vec3 vertex_normal(Index v) const {
    Vec3 normal = Vec3::Zero();
    for (const Index f : faces_around(v)) normal += area_normal(f);
    return unit_or_zero(normal);
  }
  /// Unit, weighted by angles (angle_normal).
  Vec3 middle_normal(Index v) const {
    Vec3 normal = Vec3::Zero();
    for (const Index f : faces_around(v)) {
      const auto [a, b, c] = turned_to(v, faces()[f]);
      normal += angle_normal(position(a), position(b), position(c));
    }
    return unit_or_zero(normal);
  }
  /// The corners of a face, beginning with `v`.
  static Triangle turned_to(Index v, Triangle face) {
    std::rotate(face.begin(), std::find(face.begin(), face.end(), v), face.end());
    return face;
  }
  double mean_edge(Index v) const {
    double sum = 0;
    for (const Index f : faces_around(v)) {
      for (const Index w : faces()[f]) {
        if (w != v) sum += (position(w) - position(v)).norm();
      }
    }
    return has_vertex(v) ? sum / static_cast<double>(2 * faces_around(v).size()) : 0;
  }

  /// Exchanges the edge for the other diagonal of its two faces, which must exist.
  Step flipping(const MeshEdge& e) const {
    const Index f = face_of(e.a, e.b), g = face_of(e.b, e.a);
    const auto [c, d] = opposite(e);
    return {kNone, {}, {f, g}, {{c, e.a, d}, {d, e.b, c}}};
  }
  /// Puts a vertex on an inner edge.
  Step splitting(const MeshEdge& e, const V& target) const {
    const auto added = static_cast<Index>(vertices_.size());
    Step step{added, target, {face_of(e.a, e.b), face_of(e.b, e.a)}, {}};
    for (const Index end : {e.b, e.a}) {
      for (const Index f : step.gone) step.faces.push_back(replaced(faces()[f], end, added));
    }
    return step;
  }
  Step moving(Index v, const V& target) const {
    Step step{v, target, faces_around(v), {}};
    for (const Index f : step.gone) step.faces.push_back(faces()[f]);
    return step;
  }
  /// Merges an end of an edge into the other one. Requires may_collapse().
  Step collapsing(Index from, Index into, const V& target) const {
    Step step{into, target, {}, {}};
    const Index left = face_of(from, into), right = face_of(into, from);
    for (const Index end : {from, into}) {
      for (const Index f : faces_around(end)) {
        if (f == left || f == right) continue;
        step.gone.push_back(f);
        step.faces.push_back(replaced(faces()[f], from, into));
      }
    }
    for (const Index side : {left, right}) {
      if (side != kNone) step.gone.push_back(side);
    }
    return step;
  }

  /// Takes a step, allowed or not. Faces get the numbers of those that they replace.
  void take(const Step& step) {
    if (step.vertex == vertices_.size()) {
      add_vertex(step.target);
    } else if (step.vertex != kNone) {
      edit(step.vertex) = step.target;
    }
    for (std::size_t i = step.faces.size(); i < step.gone.size(); ++i) remove_face(step.gone[i]);
    for (std::size_t i = 0; i < step.faces.size(); ++i) {
      if (i >= step.gone.size()) {
        add_face(step.faces[i]);
      } else if (faces()[step.gone[i]] != step.faces[i]) {
        set_face(step.gone[i], step.faces[i]);
      }
    }
  }

  /// Faces that are replaced by others, some with vertices that are added, which get the next numbers.
  struct Patch {
    std::vector<V> added;
    std::vector<Index> gone;
    std::vector<Triangle> faces;
  };
  /// The face as it will be with the patch.
  PlacedFace placed(const Triangle& face, const Patch& patch) const {
    PlacedFace result{face, {}};
    for (std::size_t k = 0; k < 3; ++k)
      result.points[k] =
          face[k] < vertices_.size() ? position(face[k]) : patch.added[face[k] - vertices_.size()].position;
    return result;
  }
  /// Takes a patch, allowed or not.
  void take(const Patch& patch) {
    for (const V& v : patch.added) add_vertex(v);
    for (const Index f : patch.gone) remove_face(f);
    for (const Triangle& f : patch.faces) add_face(f);
  }

  /// Removes unused numbers; returns the new numbers of the vertices. Not in a transaction.
  std::vector<Index> pack() {
    std::vector<Index> number = pack_faces();
    std::vector<V> kept;
    for (Index v = 0; v < number.size(); ++v) {
      if (number[v] != kNone) kept.push_back(std::move(vertices_[v]));
    }
    vertices_ = std::move(kept);
    return number;
  }

  /// Of all vertices.
  std::vector<Vec3> positions() const {
    std::vector<Vec3> all;
    all.reserve(vertices_.size());
    for (const V& v : vertices_) all.push_back(v.position);
    return all;
  }
  /// All vertices, and the faces that are not removed.
  TriMesh tri_mesh() const {
    TriMesh mesh{positions(), {}};
    for (Index f = 0; f < faces().size(); ++f) {
      if (has_face(f)) mesh.faces.push_back(faces()[f]);
    }
    return mesh;
  }

  /// Faces that were given other corners since the first open transaction began; some more than once, some removed.
  std::vector<Index> replaced_faces() const { return faces_since({}); }

  /// While it lives, changes of the mesh are remembered; unless they are kept, they are undone with it. May be nested.
  class Transaction {
   public:
    explicit Transaction(EditMesh& mesh) : mesh_(mesh), vertices_(mesh.vertices_.size()) {
      if (!mesh.is_open()) mesh.written_.clear();
      written_ = mesh.written_.size();
      mark_ = mesh.open();
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction() {
      if (!kept_) undo();
      mesh_.close();
    }

    void keep() { kept_ = true; }
    /// Makes the mesh what it was; the transaction goes on.
    void undo() {
      mesh_.FaceTable::undo(mark_);
      for (; mesh_.written_.size() > written_; mesh_.written_.pop_back())
        mesh_.vertices_[mesh_.written_.back().first] = std::move(mesh_.written_.back().second);
      mesh_.vertices_.resize(vertices_);
    }
    /// Faces that are new, have other corners or corners that have moved. Ascending.
    std::vector<Index> changed_faces() const {
      std::vector<Index> faces = mesh_.faces_since(mark_);
      for (std::size_t i = written_; i < mesh_.written_.size(); ++i) {
        const std::vector<Index>& around = mesh_.faces_around(mesh_.written_[i].first);
        faces.insert(faces.end(), around.begin(), around.end());
      }
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
      std::erase_if(faces, [&](Index f) { return !mesh_.has_face(f); });
      return faces;
    }

   private:
    EditMesh& mesh_;
    FaceMark mark_;
    std::size_t vertices_, written_;
    bool kept_ = false;
  };

 private:
  static Vec3 unit_or_zero(const Vec3& normal) {
    const double norm = normal.norm();
    return norm > 0 ? Vec3(normal / norm) : Vec3(Vec3::Zero());
  }
  static Triangle replaced(Triangle face, Index from, Index to) {
    std::replace(face.begin(), face.end(), from, to);
    return face;
  }

  std::vector<V> vertices_;
  std::vector<std::pair<Index, V>> written_;  // what edit() gave away since the first open transaction began
};

}  // namespace vmesh
