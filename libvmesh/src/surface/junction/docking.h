#pragma once

#include <functional>
#include <vector>

#include "vmesh/core/types.h"
#include "vmesh/mesh/tri_mesh.h"

namespace vmesh {

/// A closed piece of surface from which discs are cut.
class DiscCutter {
 public:
  DiscCutter(std::vector<Vec3> vertices, std::vector<Triangle> faces);

  /// Cuts off the tip of a vessel: what lies around the vertex of `own` farthest along `normal`, beyond the plane
  /// through `center`. Only vertices of `own` go; faces are cut where they cross the plane. Where that is no disc, the
  /// farthest vertex goes alone; without one, a window is opened in the face nearest to the tip. Returns the rim,
  /// counter-clockwise about `normal`; no two rims touch. Edges of the rim shorter than `shortest` are collapsed where
  /// that keeps the surface's topology.
  std::vector<Index> cut(const Vec3& center, const Vec3& normal, const std::vector<Index>& own, double shortest);

  void move(Index v, const Vec3& position) { vertices_[v] = position; }

  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// The vertex of the piece that vertex `v` is, or that it was made next to.
  Index source(Index v) const { return source_[v]; }
  /// Faces that are left.
  std::vector<Triangle> rest() const;

 private:
  using Height = std::function<double(const Vec3&)>;  // over the surface at which is cut

  Index farthest(const Vec3& normal, const std::vector<Index>& own) const;
  std::vector<Index> region_above(Index apex, const Height& height, const std::vector<Index>& own) const;
  bool is_disc(const std::vector<Index>& region) const;
  std::vector<Index> cut_off(const std::vector<Index>& region, const Height& height);
  std::vector<Index> open_window(const Vec3& near);
  void collapse_short_edges(std::vector<Index>& rim, double shortest);
  bool collapsible(Index v, Index into) const;
  void collapse(Index v, Index into);
  std::vector<Index> neighbours(Index v) const;
  Index add_vertex(const Vec3& position, Index source);
  void add_face(const Triangle& face);
  void add_quad(Index a, Index b, Index c, Index d);
  std::vector<Index> faces_around(const std::vector<Index>& region) const;

  std::vector<Vec3> vertices_;
  std::vector<Triangle> faces_;
  std::vector<Index> source_;
  std::vector<std::vector<Index>> faces_of_;
  std::vector<char> removed_face_, removed_vertex_;
};

}  // namespace vmesh
