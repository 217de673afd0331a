#pragma once

#include <functional>
#include <vector>

#include "vmesh/edit/edit_mesh.h"

namespace vmesh {

/// A closed surface from which discs are cut.
class DiscCutter {
 public:
  /// A vertex, and the original one that it is or was added next to.
  struct Vertex {
    Vec3 position = Vec3::Zero();
    Index source = kNone;
  };

  DiscCutter(const std::vector<Vec3>& positions, std::vector<Triangle> faces);

  /// Cuts off the tip of a vessel: the region beyond the plane through `center` that is connected to the vertex of
  /// `own` farthest along `normal`. Only vertices of `own` are removed; faces that cross the plane are cut. If the
  /// region is not a disc, only the farthest vertex is removed; if there is none, a hole is cut in the face nearest to
  /// the tip. Returns the rim, counter-clockwise about `normal`; no two rims touch. Rim edges shorter than `shortest`
  /// are collapsed where that keeps the topology.
  std::vector<Index> cut(const Vec3& center, const Vec3& normal, const std::vector<Index>& own, double shortest);

  void move(Index v, const Vec3& position) { mesh_.edit(v).position = position; }

  const std::vector<Vertex>& vertices() const { return mesh_.vertices(); }
  /// All vertices and the remaining faces.
  TriMesh rest() const { return mesh_.tri_mesh(); }

 private:
  using Height = std::function<double(const Vec3&)>;  // above the cutting surface

  Index farthest(const Vec3& normal, const std::vector<Index>& own) const;
  std::vector<Index> region_above(Index apex, const Height& height, const std::vector<Index>& own) const;
  bool is_disc(const std::vector<Index>& region) const;
  std::vector<Index> cut_off(const std::vector<Index>& region, const Height& height);
  std::vector<Index> open_window(const Vec3& near);
  void collapse_short_edges(std::vector<Index>& rim, double shortest);
  bool may_collapse(Index v, Index into) const;
  void add_quad(Index a, Index b, Index c, Index d);
  std::vector<Index> faces_around(const std::vector<Index>& region) const;

  EditMesh<Vertex> mesh_;
  mutable std::vector<char> open_;  // of vertices, scratch of region_above(): kept, as there may be many cuts
};

}  // namespace vmesh
